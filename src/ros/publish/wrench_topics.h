#pragma once

#include <ros/ros.h>

#include <future>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace verlet_cable {

/// Topics of geometry_msgs/WrenchStamped, one a name. A topic exists as long as its name, except for the time that the master
/// takes, for which the node does not wait.
class WrenchTopics {
 public:
  explicit WrenchTopics(const ros::NodeHandle& node) : node_(node) {}
  /// The names that there are now; those that ROS does not allow have no topic.
  void follow(const std::vector<std::string_view>& names);
  /// The topic of a name; null where nobody listens to it.
  const ros::Publisher* listened(const std::string& name) const;

 private:
  using Topics = std::map<std::string, ros::Publisher>;

  ros::NodeHandle node_;
  Topics topics_;
  std::future<Topics> new_topics_;  // that are being registered
};

}  // namespace verlet_cable

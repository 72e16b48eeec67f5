#pragma once

#include <ros/ros.h>
#include <visualization_msgs/InteractiveMarker.h>
#include <visualization_msgs/InteractiveMarkerFeedback.h>
#include <visualization_msgs/InteractiveMarkerInit.h>
#include <visualization_msgs/InteractiveMarkerUpdate.h>

#include <cstdint>
#include <functional>
#include <map>
#include <string>

namespace verlet_cable {

/// The topics of an interactive marker server, as the library interactive_markers has them, but for its use of time: that one
/// subtracts and adds ROS times in threads of its own, which ends the process near the ends of their range.
class HandleServer {
 public:
  using Feedback = visualization_msgs::InteractiveMarkerFeedback;

  /// `receive` gets the feedback on markers that are there, and while one client drags a marker only its own.
  HandleServer(const ros::NodeHandle& node, const std::string& topic, std::function<void(const Feedback&)> receive);

  // Seen after the next `apply_changes`.
  void insert(const visualization_msgs::InteractiveMarker& marker);
  void set_pose(const std::string& marker, const geometry_msgs::Pose& pose);
  void erase(const std::string& marker);
  void clear();

  /// Whether a viewer shows it where its mouse is, or was a short time ago.
  bool may_be_elsewhere(const std::string& marker) const;

  void apply_changes();
  std::uint32_t viewers() const { return updates_.getNumSubscribers(); }

 private:
  struct Client {
    std::string id;
    ros::WallTime last;  ///< when it was heard of
  };

  void take(const Feedback& feedback);
  visualization_msgs::InteractiveMarkerInit all() const;

  const std::function<void(const Feedback&)> receive_;
  std::map<std::string, visualization_msgs::InteractiveMarker> markers_;  ///< by name
  std::map<std::string, Client> clients_;                                 ///< by the marker they drag
  std::map<std::string, ros::WallTime> heard_of_;                         ///< the last feedback on each marker
  visualization_msgs::InteractiveMarkerUpdate changes_;                   ///< since the last `apply_changes`
  std::uint64_t sequence_ = 0;
  ros::Publisher updates_, all_;
  ros::Subscriber feedback_;
  ros::WallTimer timer_;
};

}  // namespace verlet_cable

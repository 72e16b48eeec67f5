#pragma once

#include <ros/ros.h>
#include <visualization_msgs/MarkerArray.h>

#include <map>
#include <set>
#include <string>

#include "verlet_cable/ros/simulation.h"

namespace verlet_cable {

/// Topic `obstacles`: a perception node adds, moves and removes obstacles by markers. What it asks for is done between steps, as
/// all callbacks come from one thread. A marker that is refused is logged, counted, and changes nothing.
class ObstacleListener {
 public:
  ObstacleListener(ros::NodeHandle& private_node, Simulation& simulation);

  int refused_count() const { return refused_count_; }               ///< markers since the start
  const std::string& last_problem() const { return last_problem_; }  ///< why the last of them was refused

 private:
  struct Failure {
    ros::WallTime time;
    std::string problem;
  };

  void receive(const visualization_msgs::MarkerArray& markers);
  /// Why the marker was refused, empty if it was not. Adds to `gone` what it deletes.
  std::string apply(const visualization_msgs::Marker& marker, std::set<std::string>& gone);
  std::string add(const visualization_msgs::Marker& marker);
  std::string find_mesh(Obstacle& obstacle);

  Simulation& simulation_;
  std::map<std::string, Failure> failures_;  ///< of meshes that could not be read, by their URIs
  int refused_count_ = 0;
  std::string last_problem_;
  ros::Subscriber subscriber_;
};

}  // namespace verlet_cable

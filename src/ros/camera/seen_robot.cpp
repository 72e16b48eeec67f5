#include "camera/seen_robot.h"

#include <ros/console.h>

#include <utility>

#include "scene/scene_files.h"
#include "verlet_cable/core/obstacle_of.h"

namespace verlet_cable {
namespace {

view::Look robot_look() {
  view::Look look;
  look.color = {0.72, 0.73, 0.76};
  look.shininess = 0.3;
  return look;
}

}  // namespace

SeenRobot::SeenRobot(const std::string& urdf, const std::string& parameter) {
  SceneSources sources;
  sources.parameter = [&](const std::string&) { return std::optional(urdf); };
  RobotDesc robot;
  robot.description = parameter;
  robot.geometry = RobotDesc::Geometry::visual;
  ErrorList errors;
  read_robot_files({YAML::Node(), "", &errors}, sources, robot);
  if (!errors.empty()) throw SceneError(errors.take());
  for (const std::string& problem : robot.left_out) ROS_WARN("%s", problem.c_str());
  for (const LinkDesc& link : robot.tree) {
    if (link.obstacles.empty()) continue;
    links_.push_back(link.name);
    std::vector<view::Part>& parts = parts_.emplace_back();
    for (const ObstacleDesc& desc : link.obstacles) {
      const Obstacle visual = obstacle_of(desc);
      parts.push_back({visual.pose, visual.shape, robot_look()});
    }
  }
}

void SeenRobot::add(std::size_t link, const Pose& pose, view::Thing& thing) const {
  for (view::Part part : parts_[link]) {
    part.pose = pose * part.pose;
    thing.parts.push_back(std::move(part));
  }
}

}  // namespace verlet_cable

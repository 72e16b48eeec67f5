#pragma once

#include <geometry_msgs/Point.h>
#include <geometry_msgs/Pose.h>

#include <optional>
#include <string>

#include "verlet_cable/core/scene_desc.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// The frame that a node sends at its scene's `origin`, after the node's name: `cable_origin` for `/cable`.
std::string origin_frame_of(const std::string& node);

/// The frame in which everything is given that is drawn: the scene's fixed frame, or, with an `origin`, a frame there, as clouds
/// and viewers have single precision.
struct DrawingFrame {
  DrawingFrame(const SceneDesc& scene, const std::string& node);

  std::string name;
  Vector3 origin;  ///< [m] in the fixed frame, whose axes it has

  geometry_msgs::Point point(const Vector3& position) const;  ///< of one in the fixed frame
  geometry_msgs::Pose pose(const Pose& pose) const;           ///< likewise
  void enter(geometry_msgs::Point& position) const;           ///< from the fixed frame
};

/// Where a cable is so far from the origin of what is drawn that single precision shows, what to do about it.
std::optional<std::string> coarse_drawing(const World& world, const DrawingFrame& frame);

}  // namespace verlet_cable

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "camera/mesh_shelf.h"
#include "camera/moment.h"
#include "camera/seen_robot.h"
#include "verlet_cable/view/drawing.h"

namespace verlet_cable {

/// What there is to be seen at a moment, in the fixed frame. The order of things is that of their numbers in masks: cables, nets
/// and particles, by `cable_id` of the topic `points`; bodies; what `labels` names, whether it is there or not; then all else.
/// `link_poses`: of the robot's links; none: not seen. With a robot, the geometry that cables touch of its links is not seen.
view::Drawing drawing_of(const Moment& moment, const SeenRobot& robot, const std::vector<std::optional<Pose>>& link_poses,
                         const std::vector<std::string>& labels, MeshShelf& meshes);

}  // namespace verlet_cable

#pragma once

#include <visualization_msgs/Marker.h>

#include <string>
#include <vector>

#include "verlet_cable/core/obstacle.h"

namespace verlet_cable {

/// How an obstacle of a world looks with its frame at `frame`: one marker, for a capsule three. Only `type`, `pose`, `scale`,
/// `color` and `mesh_resource` are set. A plane is a large flat box below it. Padding is not shown.
std::vector<visualization_msgs::Marker> obstacle_markers(const Obstacle& obstacle, const Pose& frame);

/// The obstacle that a marker of the topic `obstacles` asks for, without its frame.
struct MarkerObstacle {
  std::string problem;  ///< what is wrong with the marker, with the field, its value and what is allowed; empty: nothing
  Obstacle obstacle;    ///< of a mesh only the place and the scale are known: it has not been read
};
MarkerObstacle obstacle_of(const visualization_msgs::Marker& marker);

}  // namespace verlet_cable

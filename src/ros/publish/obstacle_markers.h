#pragma once

#include <visualization_msgs/Marker.h>

#include <array>
#include <string>
#include <vector>

#include "verlet_cable/core/obstacle.h"
#include "verlet_cable/core/shape.h"

namespace verlet_cable {

/// Of the shapes of bodies: red, green, blue, alpha.
constexpr std::array<double, 4> body_color{0.75, 0.55, 0.25, 1};

/// How a shape looks at `pose`, as an obstacle: one marker, for a capsule three. Only `type`, `pose`, `scale`, `color` and
/// `mesh_resource` are set. A plane is a large flat box below it.
std::vector<visualization_msgs::Marker> shape_markers(const Shape& shape, const Pose& pose);

/// The obstacle that a marker of the topic `obstacles` asks for, without its frame.
struct MarkerObstacle {
  std::string problem;  ///< what is wrong with the marker, with the field, its value and what is allowed; empty: nothing
  Obstacle obstacle;    ///< of a mesh only the place and the scale are known: it has not been read
};
MarkerObstacle obstacle_of(const visualization_msgs::Marker& marker);

}  // namespace verlet_cable

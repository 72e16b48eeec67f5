#pragma once

#include <visualization_msgs/Marker.h>

#include <vector>

#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// Fills the marker's points and colors with the triangles of a round tube of `radius` [m] along `centers`, closed by half
/// spheres; for type TRIANGLE_LIST. Rings are carried from node to node without turning about the tube, so that it never looks
/// wrung. Long cables get fewer sides and, from 200 segments on, fewer rings than nodes: a message stays below 300 kB. So do
/// tubes that may not have more than `most_corners` (72 at least) in all their triangles. `centers`: two points or more;
/// `colors`: one a center.
void fill_tube(const std::vector<Vector3>& centers, const std::vector<std_msgs::ColorRGBA>& colors, double radius,
               int most_corners, visualization_msgs::Marker& marker);

}  // namespace verlet_cable

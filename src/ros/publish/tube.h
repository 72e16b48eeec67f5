#pragma once

#include <visualization_msgs/Marker.h>

#include <vector>

#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// Fills the marker's points and colors with the triangles of a round tube of `radius` [m] along `centers`, closed by half
/// spheres; for type TRIANGLE_LIST. Rings are carried along without turning about the tube, so that it never looks wrung.
///
/// How large a tube is on a screen nobody here knows: it is as fine as can be seen from a metre away. Its 7 to 21 sides, more for
/// thick cables, are within 1 mm of the round tube, or a tenth of the radius of thin ones. It has as many rings as it takes to be
/// within 3 % of the radius, and 1 mm, of the cable's line and to show the colors of all nodes: few where it is straight; where
/// it bends with a radius R one in sqrt(0.24 radius R) at least, two at most, and never more than there are nodes.
///
/// Tubes that may not have more than `most_corners` (72 at least) in all their triangles get fewer sides, down to 3, cones as
/// ends, and at last as many rings as there may be, most where they bend; so do tubes of more than 7500 corners (300 kB).
/// `centers`: two points or more; `colors`: one a center.
void fill_tube(const std::vector<Vector3>& centers, const std::vector<std_msgs::ColorRGBA>& colors, double radius,
               int most_corners, visualization_msgs::Marker& marker);

}  // namespace verlet_cable

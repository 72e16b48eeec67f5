#pragma once

#include <std_msgs/ColorRGBA.h>
#include <visualization_msgs/Marker.h>

#include <vector>

#include "verlet_cable/core/scene_desc.h"
#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// What is shown of a cable.
struct CableLook {
  const std::vector<Vector3>& centers;      ///< [m] two or more
  std::vector<std_msgs::ColorRGBA> colors;  ///< one a center
  double radius;                            ///< [m] the largest
  std::vector<double> segment_radii = {};   ///< [m] one between each two centers; none: all have that
};

/// Markers of cables: type, scale, color, points and colors; all else is the caller's.
///
/// Style line: a LINE_STRIP through all centers. Style tube: a TRIANGLE_LIST, with rings where the cable bends or changes its
/// color, so that straight stretches are off its line by no more than half a millimetre, or a tenth of the radius of thin ones,
/// and turn against each other by no more than a fifth of a radian, a quarter in the sharpest bends, where the cable has nodes
/// enough for it.
///
/// Where all tubes together would take more than 15000 corners of triangles (0.6 MB), and of a cable that alone would take more
/// than 7500, the tube is drawn as a line, as wide as the tube and through the same rings. In rviz, which draws triangles that
/// have colors without light, both look alike, and a line takes a thirtieth of the bytes. Lines share 15000 points; with less
/// than it takes, the points are most where the cable bends.
std::vector<visualization_msgs::Marker> cable_markers(const std::vector<CableLook>& cables, MarkerStyle style);

}  // namespace verlet_cable

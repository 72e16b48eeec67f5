#pragma once

#include <visualization_msgs/Marker.h>

#include <vector>

#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// How a round tube is divided into triangles.
struct TubeDetail {
  std::vector<int> rings;  ///< the nodes that have one
  int sides;
  int cap_rings;  ///< of the half sphere at each end, between its tip and its rim

  int corners() const;  ///< of all triangles
};

/// [m] By which straight stretches may be off the line of a cable of this radius.
double line_tolerance(double radius);

/// For a tube of `radius` [m] that has its rings at these nodes.
///
/// How large it is on a screen nobody here knows: it is as fine as can be seen from a metre away. Colors are shaded from corner
/// to corner, so that what is seen of the sides is the outline. Sides are 5 to 21, more for thick cables, and no deeper inside
/// the round tube than 1.2 mm, or an eighth of the radius of thin ones.
TubeDetail tube_detail(double radius, std::vector<int> rings);

/// Fills the marker's points and colors, in the light of light.h, with the triangles of a round tube of `radius` [m] along
/// `centers`, closed by half spheres; for type TRIANGLE_LIST. Rings are carried along without turning about the tube, so that it
/// never looks wrung. `centers`: two points or more; `colors`: one a center; `radii` [m]: one a ring, none where all have
/// `radius`.
void fill_tube(const std::vector<Vector3>& centers, const std::vector<std_msgs::ColorRGBA>& colors, double radius,
               const TubeDetail& detail, visualization_msgs::Marker& marker, const std::vector<double>& radii = {});

}  // namespace verlet_cable

#pragma once

#include <string>
#include <vector>

#include "verlet_cable/core/types.h"

namespace verlet_cable::cable_fit {

/// Points on a cable's surface as a depth camera saw them over time, in no order.
struct Clouds {
  std::vector<double> times;                 ///< [s] ascending
  std::vector<std::vector<Vector3>> points;  ///< [m] a time

  std::size_t point_count() const;
};

/// Reads a CSV file with the header `t,x,y,z` [s, m]: a row a point, times that do not descend, from 0; points of one time are
/// one cloud. Adds a line to `errors` for each row that is wrong (at most 100), and where there are fewer than 2 or more than
/// 2,000,000 points.
Clouds read_clouds(const std::string& path, std::vector<std::string>& errors);

/// How far [m] points are outside of a tube of a radius about a line of points; negative inside.
std::vector<double> distances_from_tube(const std::vector<Vector3>& points, const std::vector<Vector3>& nodes, double radius);

}  // namespace verlet_cable::cable_fit

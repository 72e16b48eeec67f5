#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "scene/scene_errors.h"

namespace verlet_cable {

/// [m]
inline double polyline_length(const std::vector<Vector3>& points) {
  double length = 0;
  for (std::size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
  return length;
}

/// Whether a cable may have the shape of a polyline. `length`: of the cable at rest, `present_length`: as it is strained now [m].
inline void check_polyline_length(const std::string& key, const std::vector<Vector3>& points, double length,
                                  double present_length, Errors& errors) {
  constexpr double largest_error = 0.05;
  constexpr int digits = 9;
  const double given = polyline_length(points);
  const double least = (1 - largest_error) * std::min(length, present_length);
  const double most = (1 + largest_error) * std::max(length, present_length);
  if (!std::isfinite(given) || (given >= least && given <= most)) return;
  const std::string at_rest = rounded_text(length, digits), now = rounded_text(present_length, digits);
  errors.add(key, "a polyline of " + rounded_text(given) + " m",
             "at most 5 % more or less than the cable's length " + at_rest + " m" +
                 (now == at_rest ? "" : ", or than the " + now + " m to which it is strained"));
}

}  // namespace verlet_cable

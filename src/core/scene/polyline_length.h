#pragma once

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "scene/scene_errors.h"

namespace verlet_cable {

/// Whether a cable of a length [m] may have the shape of a polyline.
inline void check_polyline_length(const std::string& key, const std::vector<Vector3>& points, double cable_length,
                                  Errors& errors) {
  constexpr double largest_error = 0.05;
  double length = 0;
  for (std::size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
  if (std::isfinite(length) && std::abs(length - cable_length) > largest_error * cable_length)
    errors.add(key, "a polyline of " + rounded_text(length) + " m",
               "at most 5 % more or less than the cable's length " + rounded_text(cable_length, 9) + " m");
}

}  // namespace verlet_cable

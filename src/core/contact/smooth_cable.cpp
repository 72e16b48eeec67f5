#include "contact/smooth_cable.h"

#include <algorithm>

#include "chain/direction.h"

namespace verlet_cable {

Vector3 arc_height(const CableState& state, int segment) {
  const int before = std::max(segment - 1, 0), after = std::min(segment + 1, state.segments() - 1);
  if (before == after) return Vector3::Zero();
  const Vector3 turned = (segment_direction(state, after) - segment_direction(state, before)) / (after - before);
  return -(state.positions[segment + 1] - state.positions[segment]).norm() / 8 * turned;
}

double bulge_along(const Vector3& normal, const CableState& state, int segment, double fraction, double radius) {
  const double highest = normal.dot(arc_height(state, segment));
  return 4 * fraction * (1 - fraction) * std::clamp(highest, -largest_arc * radius, largest_arc * radius);
}

}  // namespace verlet_cable

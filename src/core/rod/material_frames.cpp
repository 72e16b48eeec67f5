#include "rod/material_frames.h"

#include <cmath>

namespace verlet_cable {

Vector3 rotation_between(const Quaternion& from, const Quaternion& to) {
  const Eigen::AngleAxisd rotation(to * from.conjugate());
  const double angle = rotation.angle() > M_PI ? rotation.angle() - 2 * M_PI : rotation.angle();
  return angle * rotation.axis();
}

void carry_directors(const CableState& state, const VectorArray& segment, VectorArray& director) {
  const auto half_turn = [&](int i) { return 0.5 * state.twist[i] * state.rest_lengths[i]; };
  const auto carry = [&](int first, int step, int end) {
    Vector3 direction = state.reference_orientation * Vector3::UnitX();
    Vector3 normal = state.reference_orientation * Vector3::UnitY();
    double turn = 0;
    for (int i = first; i != end; i += step) {
      // What has no length does not turn them.
      const Vector3 way = get(segment, i), next = way.isZero(0) ? direction : Vector3(way.normalized());
      normal = parallel_transport(normal, direction, next);
      turn += step * half_turn(i);
      if (turn != 0) normal = std::cos(turn) * normal + std::sin(turn) * next.cross(normal);
      turn = step * half_turn(i);
      direction = next;
      set(director, i, normal);
    }
  };
  carry(state.reference_node, 1, state.segments());
  carry(state.reference_node - 1, -1, -1);
}

}  // namespace verlet_cable

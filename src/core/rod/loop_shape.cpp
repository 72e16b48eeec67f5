#include "rod/loop_shape.h"

#include <algorithm>
#include <cmath>

namespace verlet_cable {

void lay_loop(int first, int last, CableState& state) {
  const int before = std::max(first - 1, 0);
  const Vector3 start = state.positions[first], way = state.positions[before + 1] - state.positions[before];
  const Vector3 along = way.norm() > 0 ? Vector3(way.normalized()) : Vector3(Vector3::UnitX());
  const Vector3 aside = along.unitOrthogonal();
  const double length = state.length(first, last), segment = length / (last - first);
  // Of a circle whose chords are as long as segments.
  const double radius = 0.5 * segment / std::sin(M_PI * segment / length);
  const Vector3 shift = start - state.positions[last];
  double arc = 0;
  for (int i = first + 1; i < last; ++i) {
    arc += state.rest_lengths[i - 1];
    const double angle = 2 * M_PI * arc / length;
    state.positions[i] = start + radius * (std::sin(angle) * along + (1 - std::cos(angle)) * aside);
  }
  for (int i = last; i < state.nodes(); ++i) state.positions[i] += shift;
}

}  // namespace verlet_cable

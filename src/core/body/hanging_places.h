#pragma once

#include <vector>

#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// What hangs on cables: a body, which turns, or a point that joins cables, which does not.
struct HangingBody {
  Pose pose;                         ///< where it is looked for first; then where it hangs
  Vector3 center = Vector3::Zero();  ///< [m] where its weight is, in its frame
  double weight = 0;                 ///< [N] below 0: it is lifted; all together weigh more than nothing
  bool turns = true;
};

/// A point of a body, or a place that stays, at which a cable ends.
struct HangingEnd {
  int body = -1;                    ///< -1: it stays
  Vector3 point = Vector3::Zero();  ///< [m] in the body's frame, or in space
  Vector3 axis = Vector3::Zero();   ///< of a clamp: in which direction the span leaves it, in the body's frame or in space
  double stiffness = 0;             ///< [N m] of the clamp against a turn of the span's chord, per radian
};

/// A cable between two ends.
struct HangingSpan {
  HangingEnd ends[2];
  std::vector<double> lengths;      ///< [m] of its segments at rest (n)
  std::vector<double> weights;      ///< [N] of the nodes between them (n - 1)
  std::vector<double> compliances;  ///< [1/N] strain per tension (n); 0: a segment that cannot stretch
};

/// A start strains what can stretch by this much at most, whatever it carries.
constexpr double largest_start_strain = 0.019;

/// Puts bodies where they hang at rest on their spans: where their weights and the spans' have the least energy. A span's is that
/// of a chain in equilibrium between its ends, the Legendre transform of its complementary energy, a convex function of the force
/// at its end; what cannot stretch, or not further, yields by a part of 1e-7 where it carries as much as the weight of all there
/// is and what clamps turn spans with. Newton's method, from loose spans to tight ones; of several places, one downhill from
/// where the bodies are. `down`: the direction of weights.
void find_hanging_places(const std::vector<HangingSpan>& spans, const Vector3& down, std::vector<HangingBody>& bodies);

/// The vector from a span's first end to its second [m].
Vector3 chord(const HangingSpan& span, const std::vector<HangingBody>& bodies);

}  // namespace verlet_cable

#pragma once

#include <cmath>
#include <vector>

#include "target/kinematic_targets.h"
#include "verlet_cable/core/cable.h"

namespace verlet_cable {

/// How a cable bends and twists at a node between two segments, or between a clamp and a segment beside it.
struct Joint {
  enum class Side { both, before, after };  ///< of the node: what of the cable bends there
  int node = 0;
  Side side = Side::both;
  double place = 0;                                           ///< [m] of the node from the start, at rest
  double length = 0;                                          ///< [m] of the cable that bends, at rest
  Vector3 first = Vector3::Zero(), second = Vector3::Zero();  ///< the directions between which it does
  double twist = 0;                                           ///< [rad/m]

  double curvature() const { return std::atan2(first.cross(second).norm(), first.dot(second)) / length; }  ///< [1/m]
};

/// Calls visitor(joint) for all of them from start to end. `clamps` ascend by node.
template <class Visitor>
void visit_joints(const CableState& state, const std::vector<DirectionTarget>& clamps, const Visitor& visitor) {
  const int n = state.segments();
  const auto direction = [&](int i) -> Vector3 { return state.positions[i + 1] - state.positions[i]; };
  auto clamp = clamps.begin();
  double place = 0;
  for (int i = 0; i <= n; ++i) {
    const double before = i > 0 ? 0.5 * state.rest_lengths[i - 1] : 0, after = i < n ? 0.5 * state.rest_lengths[i] : 0;
    place += before;
    const bool whole = !state.directors.empty(), inside = i > 0 && i < n;
    if (clamp != clamps.end() && clamp->node == i) {
      const Vector3 held = clamp->orientation * Vector3::UnitX();
      if (i > 0) {
        const double twist = inside ? clamp->twist_before : whole ? state.joint_twist[i] : 0;
        visitor(
            Joint{i, Joint::Side::before, place, before, direction(i - 1), held, whole ? twist / before : state.twist[i - 1]});
      }
      if (i < n) {
        const double twist = inside ? clamp->twist_after : whole ? state.joint_twist[i] : 0;
        visitor(Joint{i, Joint::Side::after, place, after, held, direction(i), whole ? twist / after : state.twist[i]});
      }
      ++clamp;
    } else if (inside) {
      const double length = before + after;
      visitor(Joint{i, Joint::Side::both, place, length, direction(i - 1), direction(i),
                    whole ? state.joint_twist[i] / length : 0.5 * (state.twist[i - 1] + state.twist[i])});
    }
    place += after;
  }
}

}  // namespace verlet_cable

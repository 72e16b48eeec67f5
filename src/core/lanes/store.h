#pragma once

#include "lanes/records.h"

namespace verlet_cable {
// Without linkage: what is compiled for one processor is not to be used for another.
namespace {

template <Bends bends, bool is_elastic, bool all, class Real>
[[gnu::always_inline]] inline void store_place(const LaneWork& w, int k) {
  const Place<Real> at = place_of<Real>(w, k);
  const Scatter<all, Real> scatter(w, k);
  scatter.add_to_nodes(&LaneCable::positions, at.vector(LaneField::displacement_x));
  scatter.nodes(&LaneCable::velocities, at.vector(LaneField::end_velocity_x));
  scatter.nodes(&LaneCable::accelerations, at.vector(LaneField::acceleration_x));
  if (w.law.is_watched) {
    scatter.nodes(&LaneCable::acceleration_changes, at.vector(LaneField::change_x));
    scatter.nodes(&LaneCable::turns, at.vector(LaneField::turn_x));
  }
  Real length = at[LaneField::target_length];
  if constexpr (is_elastic) {
    const VectorOf<Real> end = at.vector(LaneField::segment_x);
    length = at[LaneField::start_length] + 0.5 * (root(dot(end, end)) - at[LaneField::start_length]);
  }
  const Real multiplier = at[LaneField::density] * length;
  Real tension = multiplier;
  if constexpr (bends != Bends::not_at_all) tension = tension + at[LaneField::force_along];
  const Real last = gather_segment<Real>(w, &LaneCable::last_tension, k);
  scatter.segments(&LaneCable::axial_multiplier, multiplier);
  scatter.segments(&LaneCable::tension, where(values_of<Real>(w.values->smooths), 0.5 * (last + tension), tension));
  scatter.segments(&LaneCable::last_tension, tension);
}

template <Bends bends, bool is_elastic, class Real>
void store_lanes(const LaneWork& w) {
  bool all = true;
  for (int i = 0; i < lanes_of<Real>; ++i) all = all && w.values->stores[i] != 0;
  for (int k = 0; k <= w.lane; ++k) {
    if (all && k > 0 && k < w.lane)
      store_place<bends, is_elastic, true, Real>(w, k);
    else
      store_place<bends, is_elastic, false, Real>(w, k);
  }
}

}  // namespace
}  // namespace verlet_cable

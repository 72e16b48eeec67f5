#pragma once

#include "lanes/records.h"
#include "law/drag.h"

namespace verlet_cable {
// Without linkage: what is compiled for one processor is not to be used for another.
namespace {

template <Bends bends, bool is_elastic, class Real>
void load_lanes(const LaneWork& w) {
  const LaneValues& values = *w.values;
  const double h = w.law.h;
  const Real zero{}, one = zero + 1.0, duration = zero + h, half_duration = zero + 0.5 * h;
  const VectorOf<Real> none{zero, zero, zero};
  const VectorOf<Real> gravity{values_of<Real>(values.gravity_x), values_of<Real>(values.gravity_y),
                               values_of<Real>(values.gravity_z)};
  const VectorOf<Real> fluid{values_of<Real>(values.fluid_x), values_of<Real>(values.fluid_y), values_of<Real>(values.fluid_z)};
  const Real drag_of_material = values_of<Real>(values.drag);
  VectorOf<Real> here = gather_vector<Real>(w, &LaneCable::positions, 0);
  Real half_before = zero, length_before = zero;
  for (int k = 0; k <= w.lane; ++k) {
    const Place<Real> at = place_of<Real>(w, k);
    const VectorOf<Real> next = gather_vector<Real>(w, &LaneCable::positions, k + 1);
    const VectorOf<Real> segment = next - here;
    here = next;
    const Real rest = gather_segment<Real>(w, &LaneCable::rest_lengths, k);
    const Real mass = gather_node<Real>(w, &LaneCable::masses, k);
    const VectorOf<Real> velocity = gather_vector<Real>(w, &LaneCable::velocities, k);
    const VectorOf<Real> acceleration = gather_vector<Real>(w, &LaneCable::accelerations, k);
    Real half = 0.5 * rest;
    if (w.padded && k == 0)
      for (int i = 1; i < lanes_of<Real>; i += 2) half[i] = 0;
    const LinearDrag<Real> drag{drag_of_material * (half_before + half), fluid, 1 / h};
    const Real inertia = 2.0 * mass / h;
    half_before = half;
    at.set(LaneField::segment_x, segment);
    at.set(LaneField::displacement_x, duration * (velocity + half_duration * acceleration));
    at.set(LaneField::load_x, mass * gravity + inertia * velocity + drag.load());
    at[LaneField::inertia] = inertia / h + drag.resistance();
    at[LaneField::movable] = at[LaneField::adjustable] = one;
    at[LaneField::target_length] = rest;
    at[LaneField::inverse_length] = 1.0 / rest;
    at[LaneField::inverse_mass] = 1.0 / mass;
    at.set(LaneField::velocity_x, velocity);
    at.set(LaneField::start_acceleration_x, acceleration);
    const Real multiplier = gather_segment<Real>(w, &LaneCable::axial_multiplier, k);
    if constexpr (is_elastic) {
      const Real start = root(dot(segment, segment));
      at[LaneField::start_length] = start;
      at[LaneField::axial_stiffness] = values_of<Real>(values.axial_stiffness) / rest;
      at[LaneField::axial_damping] = values_of<Real>(values.axial_damping) / rest;
      at[LaneField::density] = multiplier / start;
    } else {
      at[LaneField::compliance] = zero;
      at[LaneField::density] = multiplier / rest;
    }
    if constexpr (bends != Bends::not_at_all) {
      at[LaneField::joint_stiffness] = values_of<Real>(values.bending_stiffness) * (1.0 / (0.5 * (length_before + rest)));
      at.set(LaneField::clamp_force_x, none);
      at[LaneField::clamp_stiffness] = zero;
      if constexpr (bends == Bends::damped) {
        at[LaneField::joint_damping] = zero;
        at.set(LaneField::driven_x, none);
        at.set(LaneField::turned_x, none);
      }
      length_before = rest;
    }
  }
}

}  // namespace
}  // namespace verlet_cable

#pragma once

#include "contact/law.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// [N/m] Of a contact of a segment without load: it stops the segment within about a step [s].
double stopping_stiffness_of(const SimulatedCable& cable, int segment, double time_step);

/// Puts a point of the centre line where the cable touches: so far beside it [m], against the normal. Below 0 it stays; so it
/// does where the cable stands on its end.
void put_beside(const CableState& state, const Vector3& normal, double distance, CablePoint& point);

/// The part of friction that resists the rolling of a cable. One with torsional stiffness rolls as its twist lets it.
double rolling_part(const MaterialDesc& material);

/// Tells a touch of a cable that may roll in which direction (of any length), and by which part of friction that is resisted.
void let_roll(double part, const Vector3& across, Touch& touch);

}  // namespace verlet_cable

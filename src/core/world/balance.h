#pragma once

#include <vector>

#include "contact/law.h"
#include "target/boundary.h"
#include "verlet_cable/core/ledger.h"

namespace verlet_cable {

/// [J] That a force and a torque do where what they act on moves by `way` and turns from one orientation to another, by the
/// Cayley vector between them, with which a substep turns.
double work_of(const Vector3& force, const Vector3& way, const Vector3& torque, const Quaternion& from, const Quaternion& to);

/// [J] That holders that are no bodies do to a cable over a substep, by the forces on them.
double work_of_holders(const Boundary& boundary);

/// [J] Of that, what no motion has: what they do as velocities are mended at the end, and what held nodes gain beside their way.
double unresolved_work_of_holders(const Boundary& boundary);

/// Adds what contacts do over a substep: obstacles that move work, surfaces that slide or press in dissipate.
void balance_contacts(const std::vector<Touch>& touches, EnergyBalance& balance);

}  // namespace verlet_cable

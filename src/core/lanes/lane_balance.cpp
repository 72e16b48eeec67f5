#include <cmath>
#include <utility>

#include "geometry/eigen_vectors.h"
#include "lanes/lane_stepper.h"
#include "law/drag.h"
#include "law/resistance.h"
#include "law/stretch.h"

namespace verlet_cable {

double kinetic_energy_of_free(const LaneMember& member) {
  const CableState& state = *member.state;
  double energy = 0;
  for (int i = 0; i < state.nodes(); ++i) energy += 0.5 * state.masses[i] * state.velocities[i].squaredNorm();
  for (const HeldNode& held : member.substep.boundary.nodes)
    energy -= 0.5 * state.masses[held.node] * state.velocities[held.node].squaredNorm();
  return energy;
}

/// [J] Of the nodes that nothing holds, as the conserving substep left them.
double LaneStepper::kinetic_energy_before_mending(int c, const LaneMember& member) {
  double energy = 0;
  for (int i = 0; i <= work_.law.segments; ++i) {
    const Vector3 velocity =
        2 / member.substep.h * vector_at(LaneField::displacement_x, c, i) - vector_at(LaneField::velocity_x, c, i);
    energy += 0.5 * at(LaneField::movable, c, i) * member.state->masses[i] * velocity.squaredNorm();
  }
  return energy;
}

/// What the laws take and add over the substep, as CableStepper::balance_laws.
void LaneStepper::balance_laws(int c, LaneMember& member) {
  const MaterialDesc& material = member.substep.model.material;
  const bool stretches = work_.law.is_elastic && material.axial_damping > 0;
  const bool gives = !work_.law.is_elastic && member.substep.boundary.nodes.size() > 1;
  if (!gives) member.result.balance.dissipated.unresolved += std::exchange(member.state->taut_energy, 0.0);  // it was let go
  if (material.drag == 0 && !work_.law.is_damped && !stretches && !gives) return;
  read_displacement(c);
  if (material.drag > 0) balance_drag(member);
  if (work_.law.is_damped) {
    double& lost = member.result.balance.dissipated.bending;
    lost += bendings_[c].damping_work(displacement_);
    for (const ClampJoint& clamp : clamps_[c]) lost += clamp.damping_work;
  }
  if (stretches) balance_stretching(member);
  if (gives) balance_compliance(member);
}

void LaneStepper::balance_drag(LaneMember& member) {
  const Substep& s = member.substep;
  const CableState& state = *member.state;
  LinearDrag<double> drag{0, numbers_of(s.environment.fluid.velocity), 1 / s.h};
  double half_before = 0;
  for (int i = 0; i <= work_.law.segments; ++i) {
    const double half = i < work_.law.segments ? 0.5 * state.rest_lengths[i] : 0;
    drag.coefficient = s.model.material.drag * (half_before + half);
    half_before = half;
    const VectorOf<double> displacement = numbers_at(displacement_, i);
    member.result.balance.dissipated.drag += drag.loss(displacement);
    member.result.balance.work.applied += drag.work(displacement);
  }
}

void LaneStepper::balance_stretching(LaneMember& member) {
  const CableState& state = *member.state;
  const double damping = member.substep.model.material.axial_damping / member.substep.h;
  for (int i = 0; i < work_.law.segments; ++i) {
    const Vector3 end = state.positions[i + 1] - state.positions[i];
    const double growth = end.norm() - (end - get(displacement_, i + 1) + get(displacement_, i)).norm();
    member.result.balance.dissipated.axial += Resistance<double>{0, damping / state.rest_lengths[i]}.loss(growth);
  }
}

/// As CableStepper::balance_lengths, of what is taut.
void LaneStepper::balance_compliance(LaneMember& member) {
  CableState& state = *member.state;
  const std::vector<HeldNode>& held = member.substep.boundary.nodes;
  const double stored = state.taut_energy, stiffness = stiffness_of_taut(member.substep, state);
  double work = 0;
  state.taut_energy = 0;
  for (int i = held.front().node; i < held.back().node; ++i) {
    const Vector3 end = state.positions[i + 1] - state.positions[i];
    const double start_square = (end - get(displacement_, i + 1) + get(displacement_, i)).squaredNorm();
    const double length = state.rest_lengths[i], density = state.axial_multiplier[i] / length;
    work += work_of_length(density, start_square, end.squaredNorm());
    state.taut_energy += taut_energy(taut_compliance(length, stiffness), density);
  }
  member.result.balance.dissipated.unresolved += work + stored - state.taut_energy;
}

}  // namespace verlet_cable

#include <cmath>

#include "lanes/lane_stepper.h"

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
  const bool stretches = work_.law.is_elastic && material.axial_damping > 0, is_drawn_out = member.result.overstretched_node >= 0;
  if (material.drag == 0 && !work_.law.is_damped && !stretches && !is_drawn_out) return;
  displacements_.resize(work_.law.segments + 1);
  for (int i = 0; i <= work_.law.segments; ++i) displacements_[i] = vector_at(LaneField::displacement_x, c, i);
  if (material.drag > 0) balance_drag(member);
  if (work_.law.is_damped) balance_bending(c, member);
  if (stretches) balance_stretching(member);
  if (is_drawn_out) balance_drawn_out(c, member);
}

void LaneStepper::balance_drag(LaneMember& member) {
  const Substep& s = member.substep;
  const CableState& state = *member.state;
  const double drag = s.model.material.drag / s.h;
  const Vector3 flow = s.h * s.environment.fluid.velocity;
  double lost = 0, applied = 0, half_before = 0;
  for (int i = 0; i <= work_.law.segments; ++i) {
    const double half = i < work_.law.segments ? 0.5 * state.rest_lengths[i] : 0;
    const double length = half_before + half;
    half_before = half;
    const Vector3 relative = displacements_[i] - flow;
    lost += length * relative.squaredNorm();
    applied -= length * relative.dot(flow);
  }
  member.result.balance.dissipated.drag += drag * lost;
  member.result.balance.work.applied += drag * applied;
}

void LaneStepper::balance_bending(int c, LaneMember& member) {
  double lost = 0;
  for (const ClampJoint& clamp : clamps_[c]) lost += clamp.damping_work;
  const auto turned_on = [&](int i) -> Vector3 {
    return (displacements_[i + 1] - displacements_[i]) / member.state->rest_lengths[i];
  };
  Vector3 before = turned_on(0);
  for (int i = 1; i < work_.law.segments; ++i) {
    const Vector3 after = turned_on(i), change = after - before;
    before = after;
    lost += at(LaneField::joint_damping, c, i) * change.dot(change - vector_at(LaneField::turned_x, c, i));
  }
  member.result.balance.dissipated.bending += lost;
}

void LaneStepper::balance_stretching(LaneMember& member) {
  const CableState& state = *member.state;
  double lost = 0;
  for (int i = 0; i < work_.law.segments; ++i) {
    const Vector3 end = state.positions[i + 1] - state.positions[i];
    const double change = end.norm() - (end - displacements_[i + 1] + displacements_[i]).norm();
    lost += change * change / state.rest_lengths[i];
  }
  member.result.balance.dissipated.axial += member.substep.model.material.axial_damping / member.substep.h * lost;
}

void LaneStepper::balance_drawn_out(int c, LaneMember& member) {
  const CableState& state = *member.state;
  for (int i = 0; i < work_.law.segments; ++i) {
    double density = 0;
    each_lane_of(c, i, [&](int place, int lane, double) { density = value(LaneField::density, place, lane); });
    const Vector3 end = state.positions[i + 1] - state.positions[i], start = end - displacements_[i + 1] + displacements_[i];
    member.result.balance.dissipated.edits += 0.5 * density * (end.squaredNorm() - start.squaredNorm());
  }
}

}  // namespace verlet_cable

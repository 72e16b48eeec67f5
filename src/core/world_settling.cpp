#include <algorithm>

#include "length_projection.h"
#include "verlet_cable/core/world.h"
#include "world_implementation.h"

namespace verlet_cable {

namespace {

/// Settling begins with steps of this length [s] and ends with one in which inertia is nothing.
constexpr double first_settling_step = 0.01;
constexpr double last_settling_step = 1e6;
constexpr int maximum_settling_steps = 2000;
/// Where there is something to touch, no node goes further at a time than this, in radii.
constexpr double settling_reach = 1;
constexpr double settled_contact = 1e-4;       // radii
constexpr double settled_acceleration = 1e-7;  // [m/s^2]

}  // namespace

bool World::settle() {
  implementation_->unsettled.clear();
  for (Attachment& attachment : implementation_->attachments) attachment.force = attachment.torque = Vector3::Zero();
  for (int cable = 0; cable < static_cast<int>(implementation_->cables.size()); ++cable) implementation_->settle_cable(cable);
  return implementation_->unsettled.empty();
}

/// Substeps without motion, ever longer as long as they converge, until inertia carries nothing: what is left is Newton's method
/// for the equilibrium.
void World::Implementation::settle_cable(int index) {
  SimulatedCable& cable = cables[index];
  CableScratch& s = scratch[index];
  if (s.holders.nodes.empty()) return;
  aim_holders(cable.model, attachments, poses, time(), s.holders);
  put_at_aim(s.holders);
  hold_at(1, 1, s.holders, s.boundary);
  bring_to_rest(cable.state);
  ContactGroup alone;
  alone.cables.push_back(index);
  move_obstacles(1, 1, moving_obstacles);
  double h = first_settling_step;
  bool settled = false;
  for (int i = 0; i < maximum_settling_steps && !settled; ++i) {
    const SubstepResult substep = settle_substep(alone, h);
    // What inertia still carries of the loads.
    settled = substep.converged && 2 * substep.displacement / (h * h) < settled_acceleration;
    // What starts inside an obstacle is pushed out at the same pace, however long the step.
    if (!alone.contacts.touches().empty())
      settled = settled && substep.displacement < settled_contact * cable.model.material.radius;
    h = substep.converged ? std::min(4 * h, last_settling_step) : std::max(h / 8, shortest_substep);
  }
  project_velocities(cable.model, s.boundary.nodes, cable.state.positions, cable.state.velocities);
  add_forces(index, 1);
  follow_material(index);
  if (!settled) unsettled.push_back(cable.model.name);
}

/// One substep towards equilibrium of a cable that may lie on obstacles and on itself. It has not converged, too, if nodes have
/// gone so far that they may have gone through something.
SubstepResult World::Implementation::settle_substep(ContactGroup& alone, double h) {
  const int index = alone.cables.front();
  SimulatedCable& cable = cables[index];
  CableScratch& s = scratch[index];
  const Environment environment{scene.gravity, scene.fluid};
  const Substep substep{cable.model, environment, s.boundary, s.spans, h, true};
  if (moving_obstacles.empty() && !scene.contact) return s.stepper.advance(substep, cable.state);
  alone.contacts.find(cables, alone.cables, moving_obstacles, attachments, contact_rules(true), h);
  const CableState before = cable.state;
  const std::vector<TwistSpan> spans_before = s.spans;
  SubstepResult result;
  if (alone.contacts.touches().empty()) {
    result = s.stepper.advance(substep, cable.state);
  } else {
    alone.scratch.participants.clear();
    alone.scratch.participants.push_back({0, index, &s.stepper, substep, &cable.state, {}});
    alone.scratch.stepper.advance(alone.scratch.participants, alone.contacts.touches());
    result = alone.scratch.participants.front().result;
  }
  if (result.converged && result.displacement > settling_reach * cable.model.material.radius) {
    cable.state = before;
    s.spans = spans_before;
    result.converged = false;
  }
  if (result.converged) alone.contacts.keep();
  return result;
}

}  // namespace verlet_cable

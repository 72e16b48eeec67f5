#include <algorithm>

#include "verlet_cable/core/world.h"
#include "world_implementation.h"

namespace verlet_cable {

namespace {

/// Settling begins with steps of this length [s] and ends with one in which inertia is nothing.
constexpr double first_settling_step = 0.01;
constexpr double last_settling_step = 1e6;
constexpr int maximum_settling_steps = 2000;
constexpr double settled_acceleration = 1e-7;  // [m/s^2]

}  // namespace

bool World::settle() {
  bool settled = true;
  for (Attachment& attachment : implementation_->attachments) attachment.force = attachment.torque = Vector3::Zero();
  for (int cable = 0; cable < static_cast<int>(implementation_->cables.size()); ++cable)
    settled = implementation_->settle_cable(cable) && settled;
  return settled;
}

/// Substeps without motion, ever longer as long as they converge, until inertia carries nothing: what is left is Newton's method
/// for the equilibrium.
bool World::Implementation::settle_cable(int index) {
  SimulatedCable& cable = cables[index];
  CableScratch& s = scratch[index];
  if (s.holders.nodes.empty()) return true;
  aim_holders(cable.model, attachments, poses, time(), scene.time_step, s.holders);
  jump_to_aim(s.holders);
  hold_at(1, 1, s.holders, s.boundary);
  bring_to_rest(cable.state);
  const Environment environment{scene.gravity.acceleration, scene.fluid};
  double h = first_settling_step;
  bool settled = false;
  for (int i = 0; i < maximum_settling_steps && !settled; ++i) {
    const SubstepResult substep = s.stepper.advance({cable.model, environment, s.boundary, s.spans, h, true}, cable.state);
    // What inertia still carries of the loads.
    settled = substep.converged && 2 * substep.displacement / (h * h) < settled_acceleration;
    h = substep.converged ? std::min(4 * h, last_settling_step) : std::max(h / 8, shortest_substep);
  }
  add_forces(index, 1);
  follow_material(index);
  return settled;
}

}  // namespace verlet_cable

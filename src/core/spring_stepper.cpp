#include "spring_stepper.h"

#include <algorithm>
#include <cmath>

#include "point_contact.h"

namespace verlet_cable {

/// The net's forces as accelerations of its free nodes.
class SpringStepper::Forces : public PointForces {
 public:
  Forces(SpringStepper& stepper, const NetStep& step) : stepper_(stepper), step_(step) {}

  void accelerate(double, const std::vector<Vector3>& positions, const std::vector<Vector3>& velocities,
                  std::vector<Vector3>& accelerations) override {
    stepper_.evaluate(step_, positions, velocities);
    for (std::size_t i = 0; i < positions.size(); ++i)
      accelerations[i] = stepper_.is_held_[i]
                             ? Vector3(Vector3::Zero())
                             : Vector3(step_.scene.gravity.at(positions[i]) + stepper_.force_[i] / step_.model.masses[i]);
  }

  void hold(double part, std::vector<Vector3>& positions, std::vector<Vector3>& velocities) override {
    if (step_.holders.nodes.empty()) return;
    hold_at(0, part, step_.holders, stepper_.boundary_);
    for (const HeldNode& held : stepper_.boundary_.nodes) {
      positions[held.node] = held.position;
      velocities[held.node] = held.velocity;
    }
  }

 private:
  SpringStepper& stepper_;
  const NetStep& step_;
};

void SpringStepper::resize(const NetModel& model) {
  const std::size_t nodes = model.masses.size();
  force_.assign(nodes, Vector3::Zero());
  old_velocities_.assign(nodes, Vector3::Zero());
  tension_.assign(model.links.size(), 0.0);
  is_held_.assign(nodes, 0);
  boundary_.nodes.reserve(nodes);
  position_.assign(nodes, 0.0);
  velocity_.assign(nodes, 0.0);
  wind_.resize(model);
  integrator_.resize(nodes);
}

NetStepResult SpringStepper::advance(const NetStep& s, NetState& state, PointState& memory) {
  NetStepResult result;
  result.iterations = 1;
  std::fill(is_held_.begin(), is_held_.end(), 0);
  for (const HeldNode& held : s.held) is_held_[held.node] = 1;
  old_velocities_ = state.velocities;
  memory.positions = state.positions;
  memory.velocities = state.velocities;
  Forces forces(*this, s);
  forces.hold(0, memory.positions, memory.velocities);
  integrator_.advance(s.scene.integrator, s.h(), forces, memory);
  bounce(s, memory);
  result.finite = is_sane(memory.positions) && is_sane(memory.velocities);
  if (!result.finite) return result;
  std::swap(state.positions, memory.positions);
  std::swap(state.velocities, memory.velocities);
  if (s.scene.integrator.type != IntegratorDesc::Type::verlet) evaluate(s, state.positions, state.velocities);
  std::copy(tension_.begin(), tension_.end(), state.tension.begin());
  for (HeldNode& held : s.held) {
    const Vector3 acceleration = (state.velocities[held.node] - old_velocities_[held.node]) / s.h();
    held.force = force_on_holder(s, held, force_[held.node], Vector3::Zero(), acceleration);
  }
  for (std::size_t i = 0; i < s.model.links.size(); ++i) {
    const std::array<int, 2>& link = s.model.links[i];
    const double length = (state.positions[link[1]] - state.positions[link[0]]).norm();
    result.max_strain = std::max(result.max_strain, std::abs(length / s.model.rest_lengths[i] - 1));
  }
  return result;
}

void SpringStepper::evaluate(const NetStep& s, const std::vector<Vector3>& positions, const std::vector<Vector3>& velocities) {
  const NetModel& model = s.model;
  std::fill(force_.begin(), force_.end(), Vector3::Zero());
  for (std::size_t k = 0; k < model.links.size(); ++k) {
    const auto [i, j] = model.links[k];
    const Vector3 along = positions[j] - positions[i];
    const double length = along.norm();
    const Vector3 n = length > 0 ? Vector3(along / length) : Vector3(Vector3::Zero());
    tension_[k] = model.stiffness * (length - model.rest_lengths[k]) + model.damping * (velocities[j] - velocities[i]).dot(n);
    force_[i] += tension_[k] * n;
    force_[j] -= tension_[k] * n;
  }
  if (!(s.scene.fluid.density > 0) || !model.is_grid()) return;
  for (int i = 0; i < model.nodes(); ++i) {
    set(position_, i, positions[i]);
    set(velocity_, i, velocities[i]);
  }
  wind_.evaluate(model, s.scene.fluid, s.h(), position_, velocity_);
  if (!wind_.active()) return;
  for (int i = 0; i < model.nodes(); ++i) force_[i] += get(wind_.force(), i);
}

/// Nodes that are inside an obstacle at the end of the step are put on its surface and bounce.
void SpringStepper::bounce(const NetStep& s, PointState& memory) const {
  bool struck = false;
  for (const MovingObstacle& moving : s.obstacles) {
    for (std::size_t i = 0; i < memory.positions.size(); ++i) {
      if (is_held_[i]) continue;
      const SurfaceNear surface = surface_near(moving, memory.positions[i], 1, s.h(), 0);
      if (!(surface.distance < 0)) continue;
      memory.positions[i] -= surface.distance * surface.normal;
      memory.velocities[i] =
          bounced(memory.velocities[i], surface, s.model.restitution, moving.obstacle->friction.value_or(s.model.friction));
      struck = true;
    }
  }
  if (struck) memory.restart();
}

}  // namespace verlet_cable

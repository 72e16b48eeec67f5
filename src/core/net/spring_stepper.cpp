#include "net/spring_stepper.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "contact/point_contact.h"

namespace verlet_cable {

namespace {

/// Of a step; nets that need more are softened.
constexpr int most_parts = 32;

}  // namespace

/// The net's forces as accelerations of its free nodes.
class SpringStepper::Forces : public PointForces {
 public:
  Forces(SpringStepper& stepper, const NetStep& step) : stepper_(stepper), step_(step) {}

  /// The part of the step that is integrated.
  void go(double from, double to) {
    from_ = from;
    to_ = to;
  }

  void accelerate(double, const std::vector<Vector3>& positions, const std::vector<Vector3>& velocities,
                  std::vector<Vector3>& accelerations) override {
    stepper_.evaluate(step_, positions, velocities);
    for (std::size_t i = 0; i < positions.size(); ++i)
      accelerations[i] = stepper_.is_held_[i]
                             ? Vector3(Vector3::Zero())
                             : Vector3(step_.scene.gravity.at(positions[i]) + stepper_.force_[i] / step_.model.masses[i]);
  }

  void hold(double part, std::vector<Vector3>& positions, std::vector<Vector3>& velocities) override {
    if (step_.targets.nodes.empty()) return;
    hold_at(0, part == 1 ? to_ : from_ + part * (to_ - from_), step_.targets, stepper_.boundary_);
    for (const HeldNode& held : stepper_.boundary_.nodes) {
      positions[held.node] = held.position;
      velocities[held.node] = held.velocity;
    }
  }

 private:
  SpringStepper& stepper_;
  const NetStep& step_;
  double from_ = 0, to_ = 1;
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
  stiffness_.assign(nodes, Eigen::Matrix3d::Zero());
  damping_.assign(nodes, Eigen::Matrix3d::Zero());
  std::vector<int> links(nodes, 0);
  for (const auto& [i, j] : model.links) {
    ++links[i];
    ++links[j];
  }
  bound_ = {};
  for (std::size_t i = 0; i < nodes; ++i) {
    const double rate = 2 * links[i] / model.masses[i];
    bound_.stiffness = std::max(bound_.stiffness, rate * model.stiffness);
    bound_.damping = std::max(bound_.damping, rate * model.damping);
  }
}

/// Of the net in its shape: sum k (n.(x_i - x_j))^2 <= sum 2 k ((n.x_i)^2 + (n.x_j)^2) bounds all eigenvalues by those of the
/// nodes. Stretched links are stiff across their direction, too.
SpringStepper::Rates SpringStepper::rates_of(const NetModel& model, const std::vector<Vector3>& positions) {
  std::fill(stiffness_.begin(), stiffness_.end(), Eigen::Matrix3d::Zero());
  std::fill(damping_.begin(), damping_.end(), Eigen::Matrix3d::Zero());
  for (std::size_t k = 0; k < model.links.size(); ++k) {
    const Vector3 along = positions[model.links[k][1]] - positions[model.links[k][0]];
    const double length = along.norm();
    if (!(length > 0)) continue;
    const Eigen::Matrix3d axial = along * along.transpose() / (length * length);
    const double across = std::max(0.0, 1 - model.rest_lengths[k] / length);
    for (const int node : model.links[k]) {
      stiffness_[node] += model.stiffness * (axial + across * (Eigen::Matrix3d::Identity() - axial));
      damping_[node] += model.damping * axial;
    }
  }
  const auto largest = [](const Eigen::Matrix3d& matrix) {
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    return solver.computeDirect(matrix, Eigen::EigenvaluesOnly).eigenvalues()[2];
  };
  Rates rates;
  for (std::size_t i = 0; i < model.masses.size(); ++i) {
    if (is_held_[i]) continue;
    rates.stiffness = std::max(rates.stiffness, 2 * largest(stiffness_[i]) / model.masses[i]);
    rates.damping = std::max(rates.damping, 2 * largest(damping_[i]) / model.masses[i]);
  }
  return rates;
}

/// How many parts the step has; sets by how much the net is softened.
int SpringStepper::choose_parts(const NetStep& s, const std::vector<Vector3>& positions) {
  softening_ = 1;
  if (s.scene.integrator.type != IntegratorDesc::Type::verlet) return 1;
  const double h = s.h();
  const auto demand = [h](const Rates& rates, double parts) {
    const double part = h / parts;
    return part * (rates.damping + 0.25 * part * rates.stiffness);
  };
  if (demand(bound_, 1) <= 1) return 1;
  const Rates rates = rates_of(s.model, positions);
  int parts = 1;
  while (parts < most_parts && demand(rates, parts) > 1) ++parts;
  softening_ = std::min(1.0, 1 / demand(rates, parts));
  return parts;
}

NetStepResult SpringStepper::advance(const NetStep& s, NetState& state, PointState& memory) {
  NetStepResult result;
  std::fill(is_held_.begin(), is_held_.end(), 0);
  for (const HeldNode& held : s.held) is_held_[held.node] = 1;
  old_velocities_ = state.velocities;
  memory.positions = state.positions;
  memory.velocities = state.velocities;
  Forces forces(*this, s);
  forces.hold(0, memory.positions, memory.velocities);
  const int parts = choose_parts(s, memory.positions);
  h_ = s.h() / parts;
  for (int k = 0; k < parts; ++k) {
    const double end = static_cast<double>(k + 1) / parts;
    forces.go(static_cast<double>(k) / parts, end);
    integrator_.advance(s.scene.integrator, h_, forces, memory);
    bounce(s, end, memory);
  }
  result.iterations = parts;
  result.softened = softening_ < 1;
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
  const double stiffness = softening_ * model.stiffness, damping = softening_ * model.damping;
  std::fill(force_.begin(), force_.end(), Vector3::Zero());
  for (std::size_t k = 0; k < model.links.size(); ++k) {
    const auto [i, j] = model.links[k];
    const Vector3 along = positions[j] - positions[i];
    const double length = along.norm();
    const Vector3 n = length > 0 ? Vector3(along / length) : Vector3(Vector3::Zero());
    tension_[k] = stiffness * (length - model.rest_lengths[k]) + damping * (velocities[j] - velocities[i]).dot(n);
    force_[i] += tension_[k] * n;
    force_[j] -= tension_[k] * n;
  }
  if (!(s.scene.fluid.density > 0) || !model.is_grid()) return;
  for (int i = 0; i < model.nodes(); ++i) {
    set(position_, i, positions[i]);
    set(velocity_, i, velocities[i]);
  }
  wind_.evaluate(model, s.scene.fluid, h_, position_, velocity_);
  if (!wind_.active()) return;
  for (int i = 0; i < model.nodes(); ++i) force_[i] += get(wind_.force(), i);
}

/// Nodes that are inside an obstacle at a part of the step are put on its surface and bounce.
void SpringStepper::bounce(const NetStep& s, double part, PointState& memory) const {
  bool struck = false;
  for (const MovingObstacle& moving : s.obstacles) {
    for (std::size_t i = 0; i < memory.positions.size(); ++i) {
      if (is_held_[i]) continue;
      const SurfaceNear surface = surface_near(moving, memory.positions[i], part, s.h(), 0);
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

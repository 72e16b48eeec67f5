#include "particle/integrator.h"

#include <utility>

namespace verlet_cable {

namespace {

void resize_derivative(std::size_t count, PointState::Derivative& derivative) {
  derivative.velocities.assign(count, Vector3::Zero());
  derivative.accelerations.assign(count, Vector3::Zero());
}

}  // namespace

void PointState::resize(std::size_t count) {
  for (std::vector<Vector3>* vectors : {&positions, &velocities, &accelerations}) vectors->assign(count, Vector3::Zero());
  for (Derivative& derivative : history) resize_derivative(count, derivative);
  restart();
  is_first = true;
}

void PointIntegrator::resize(std::size_t count) {
  for (std::vector<Vector3>* vectors : {&position_, &velocity_, &next_acceleration_}) vectors->assign(count, Vector3::Zero());
  for (PointState::Derivative& stage : stage_) resize_derivative(count, stage);
}

void PointIntegrator::advance(const IntegratorDesc& desc, double h, PointForces& forces, PointState& state) {
  switch (desc.type) {
    case IntegratorDesc::Type::verlet:
      verlet(desc.first_step, h, forces, state);
      break;
    case IntegratorDesc::Type::euler:
      euler(h, forces, state);
      break;
    case IntegratorDesc::Type::rk4:
      runge_kutta(h, forces, state);
      break;
    case IntegratorDesc::Type::pc5:
      predict_and_correct(h, forces, state);
      break;
  }
  state.is_first = false;
}

/// r(n+1) = 2 r(n) - r(n-1) + h^2 f(n)/m (Verlet, Computer "Experiments" on Classical Fluids, 1967), written with the velocity
/// v(n) = (r(n+1) - r(n-1)) / 2h instead of r(n-1), which loses fewer digits (Swope et al. 1982). Where forces depend on the
/// velocity, that of the next step is first taken as v + h f/m.
void PointIntegrator::verlet(IntegratorDesc::FirstStep first_step, double h, PointForces& forces, PointState& s) {
  const std::size_t count = s.positions.size();
  if (!s.started) forces.accelerate(0, s.positions, s.velocities, s.accelerations);
  s.started = true;
  if (s.is_first && first_step == IntegratorDesc::FirstStep::lecture)
    for (std::size_t i = 0; i < count; ++i) s.velocities[i] += 0.5 * h * s.accelerations[i];
  for (std::size_t i = 0; i < count; ++i) {
    s.positions[i] += h * (s.velocities[i] + 0.5 * h * s.accelerations[i]);
    velocity_[i] = s.velocities[i] + h * s.accelerations[i];
  }
  forces.hold(1, s.positions, velocity_);
  forces.accelerate(1, s.positions, velocity_, next_acceleration_);
  for (std::size_t i = 0; i < count; ++i) s.velocities[i] += 0.5 * h * (s.accelerations[i] + next_acceleration_[i]);
  std::swap(s.accelerations, next_acceleration_);
  forces.hold(1, s.positions, s.velocities);
}

/// Explicit: r' = r + h v, v' = v + h f/m.
void PointIntegrator::euler(double h, PointForces& forces, PointState& s) {
  forces.accelerate(0, s.positions, s.velocities, s.accelerations);
  for (std::size_t i = 0; i < s.positions.size(); ++i) {
    s.positions[i] += h * s.velocities[i];
    s.velocities[i] += h * s.accelerations[i];
  }
  forces.hold(1, s.positions, s.velocities);
}

/// The classical method of the fourth order (Kutta 1901). Its first stage is left in `stage_[0]`.
void PointIntegrator::runge_kutta(double h, PointForces& forces, PointState& s) {
  const std::size_t count = s.positions.size();
  const double parts[] = {0, 0.5, 0.5, 1};
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t i = 0; i < count; ++i) {
      position_[i] = s.positions[i];
      velocity_[i] = s.velocities[i];
      if (k == 0) continue;
      position_[i] += parts[k] * h * stage_[k - 1].velocities[i];
      velocity_[i] += parts[k] * h * stage_[k - 1].accelerations[i];
    }
    if (k > 0) forces.hold(parts[k], position_, velocity_);
    stage_[k].velocities = velocity_;
    forces.accelerate(parts[k], position_, velocity_, stage_[k].accelerations);
  }
  for (std::size_t i = 0; i < count; ++i) {
    const auto mean = [&](auto member) -> Vector3 {
      return ((stage_[0].*member)[i] + 2 * (stage_[1].*member)[i] + 2 * (stage_[2].*member)[i] + (stage_[3].*member)[i]) / 6;
    };
    s.positions[i] += h * mean(&PointState::Derivative::velocities);
    s.velocities[i] += h * mean(&PointState::Derivative::accelerations);
  }
  forces.hold(1, s.positions, s.velocities);
}

/// Predicts by Adams and Bashforth, evaluates, corrects by Adams and Moulton, both of the fifth order, and evaluates again at the
/// start of the next step (PECE; Hairer, Norsett and Wanner, Solving Ordinary Differential Equations I, III.1). The first four
/// steps are Runge and Kutta's.
void PointIntegrator::predict_and_correct(double h, PointForces& forces, PointState& s) {
  const std::size_t count = s.positions.size();
  if (s.known < 4) {
    runge_kutta(h, forces, s);
    ++s.known;
  } else {
    PointState::Derivative &now = stage_[0], &next = stage_[1];
    now.velocities = s.velocities;
    forces.accelerate(0, s.positions, s.velocities, now.accelerations);
    const auto predicted = [&](std::size_t i, auto member) -> Vector3 {
      return (1901 * (now.*member)[i] - 2774 * (s.history[0].*member)[i] + 2616 * (s.history[1].*member)[i] -
              1274 * (s.history[2].*member)[i] + 251 * (s.history[3].*member)[i]) /
             720;
    };
    for (std::size_t i = 0; i < count; ++i) {
      position_[i] = s.positions[i] + h * predicted(i, &PointState::Derivative::velocities);
      velocity_[i] = s.velocities[i] + h * predicted(i, &PointState::Derivative::accelerations);
    }
    forces.hold(1, position_, velocity_);
    next.velocities = velocity_;
    forces.accelerate(1, position_, velocity_, next.accelerations);
    const auto corrected = [&](std::size_t i, auto member) -> Vector3 {
      return (251 * (next.*member)[i] + 646 * (now.*member)[i] - 264 * (s.history[0].*member)[i] +
              106 * (s.history[1].*member)[i] - 19 * (s.history[2].*member)[i]) /
             720;
    };
    for (std::size_t i = 0; i < count; ++i) {
      s.positions[i] += h * corrected(i, &PointState::Derivative::velocities);
      s.velocities[i] += h * corrected(i, &PointState::Derivative::accelerations);
    }
    forces.hold(1, s.positions, s.velocities);
  }
  for (std::size_t k = s.history.size() - 1; k > 0; --k) std::swap(s.history[k], s.history[k - 1]);
  std::swap(s.history[0], stage_[0]);
}

}  // namespace verlet_cable

#pragma once

#include <array>
#include <vector>

#include "verlet_cable/core/scene_desc.h"

namespace verlet_cable {

/// Material points in motion, and what the integrators remember of it.
struct PointState {
  std::vector<Vector3> positions;      ///< [m]
  std::vector<Vector3> velocities;     ///< [m/s] at the time of the positions
  std::vector<Vector3> accelerations;  ///< [m/s^2] Verlet: at the time of the positions, once it has started
  bool started = false;                ///< `accelerations` are set
  bool is_first = true;                ///< no step was made yet
  /// Of the steps before, the latest first: velocities and accelerations. Predictor-corrector only.
  struct Derivative {
    std::vector<Vector3> velocities, accelerations;
  };
  std::array<Derivative, 4> history;
  int known = 0;  ///< how many of `history` are set

  void resize(std::size_t count);
  /// The points were moved by something else: the integrators begin anew.
  void restart() {
    started = false;
    known = 0;
  }
};

/// What drives points over one step.
class PointForces {
 public:
  virtual ~PointForces() = default;
  /// Accelerations [m/s^2] at a part of the step, 0 to 1; zero for held points.
  virtual void accelerate(double part, const std::vector<Vector3>& positions, const std::vector<Vector3>& velocities,
                          std::vector<Vector3>& accelerations) = 0;
  /// Puts held points where they are at a part of the step.
  virtual void hold(double part, std::vector<Vector3>& positions, std::vector<Vector3>& velocities) = 0;
};

/// Moves points by one step. Keeps nothing from one call to the next.
class PointIntegrator {
 public:
  void resize(std::size_t count);
  void advance(const IntegratorDesc& desc, double h, PointForces& forces, PointState& state);

 private:
  void verlet(IntegratorDesc::FirstStep first_step, double h, PointForces& forces, PointState& state);
  void euler(double h, PointForces& forces, PointState& state);
  void runge_kutta(double h, PointForces& forces, PointState& state);
  void predict_and_correct(double h, PointForces& forces, PointState& state);

  std::vector<Vector3> position_, velocity_, next_acceleration_;  ///< of a stage
  std::array<PointState::Derivative, 4> stage_;
};

}  // namespace verlet_cable

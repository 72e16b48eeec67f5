#pragma once

#include "integrator.h"
#include "net_step.h"
#include "net_wind.h"

namespace verlet_cable {

/// Advances a net of springs, explicitly: Hooke's law and damping along each link,
///   f = -stiffness (|r_i - r_j| - l0) n - damping ((v_i - v_j) . n) n,   n = (r_i - r_j) / |r_i - r_j|
/// Stiff nets of light nodes need short steps: Verlet's method goes wrong beyond h = 2 / (largest angular frequency).
class SpringStepper {
 public:
  void resize(const NetModel& model);
  NetStepResult advance(const NetStep& step, NetState& state, PointState& memory);

 private:
  class Forces;

  void evaluate(const NetStep& step, const std::vector<Vector3>& positions, const std::vector<Vector3>& velocities);
  void bounce(const NetStep& step, PointState& memory) const;

  std::vector<Vector3> force_;   ///< nodes [N]
  std::vector<double> tension_;  ///< links [N]
  std::vector<char> is_held_;
  Boundary boundary_;
  NetWind wind_;
  VectorArray position_, velocity_;  ///< for the wind
  PointIntegrator integrator_;
  std::vector<Vector3> old_velocities_;
};

}  // namespace verlet_cable

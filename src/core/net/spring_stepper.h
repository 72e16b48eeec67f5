#pragma once

#include "net/step.h"
#include "net/wind.h"
#include "particle/integrator.h"

namespace verlet_cable {

/// Advances a net of springs, explicitly: Hooke's law and damping along each link,
///   f = -stiffness (|r_i - r_j| - l0) n - damping ((v_i - v_j) . n) n,   n = (r_i - r_j) / |r_i - r_j|
/// Verlet's method is stable while c h + (w h)^2 / 4 <= 1, w^2 and c being the largest eigenvalues of stiffness and damping over
/// mass. Steps that are longer are made in parts; nets that need too many of them are softened, and reported. The other
/// integrators are there to be compared: they step as they are told to.
class SpringStepper {
 public:
  void resize(const NetModel& model);
  NetStepResult advance(const NetStep& step, NetState& state, PointState& memory);

 private:
  class Forces;
  /// Largest eigenvalues [1/s^2], [1/s], or bounds of them.
  struct Rates {
    double stiffness = 0, damping = 0;
  };

  Rates rates_of(const NetModel& model, const std::vector<Vector3>& positions);
  int choose_parts(const NetStep& step, const std::vector<Vector3>& positions);
  void evaluate(const NetStep& step, const std::vector<Vector3>& positions, const std::vector<Vector3>& velocities);
  void bounce(const NetStep& step, double part, PointState& memory) const;

  double softening_ = 1;                              ///< of stiffness and damping in this step
  double h_ = 0;                                      ///< [s] of a part of the step
  Rates bound_;                                       ///< in any shape
  std::vector<Eigen::Matrix3d> stiffness_, damping_;  ///< nodes [N/m], [N s/m]: sums over their links
  std::vector<Vector3> force_;                        ///< nodes [N]
  std::vector<double> tension_;                       ///< links [N]
  std::vector<char> is_held_;
  Boundary boundary_;
  NetWind wind_;
  VectorArray position_, velocity_;  ///< for the wind
  PointIntegrator integrator_;
  std::vector<Vector3> old_velocities_;
};

}  // namespace verlet_cable

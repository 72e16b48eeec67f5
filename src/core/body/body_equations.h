#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

#include "body/rigid_body_stepper.h"

namespace verlet_cable {

/// The linear equations of bodies that act on each other: six unknowns a body, by what its center of mass is displaced and by
/// what it turns.
class BodyEquations {
 public:
  void resize(int bodies);
  void clear_matrix() { matrix_.setZero(); }
  auto block(int row, int column) { return matrix_.block<6, 6>(6 * row, 6 * column); }
  auto load(int body) { return load_.segment<6>(6 * body); }
  auto solution(int body) const { return solution_.segment<6>(6 * body); }
  /// The largest numbers beside the diagonal blocks' displacements and rotations.
  double largest_resistance() const;
  double largest_turning_resistance() const;
  void factor() { solver_.compute(matrix_); }
  void solve() { solution_.noalias() = solver_.solve(load_); }
  double work() const { return load_.dot(solution_); }  ///< of the loads along the solution

 private:
  Eigen::MatrixXd matrix_;
  Eigen::VectorXd load_, solution_;
  Eigen::PartialPivLU<Eigen::MatrixXd> solver_;
};

}  // namespace verlet_cable

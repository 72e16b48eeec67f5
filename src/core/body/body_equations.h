#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <utility>
#include <vector>

#include "body/rigid_body_stepper.h"

namespace verlet_cable {

/// The linear equations of bodies that act on each other: six unknowns a body, by what its center of mass is displaced and by
/// what it turns. Solved directly, in blocks of 6 x 6: a tree of bodies without any fill-in, from its leaves. Which blocks there
/// are and in which order bodies are eliminated is found anew only when other bodies act on each other.
class BodyEquations {
 public:
  // Which bodies act on each other: begin; couple, in any order, also again; end.
  void begin(int bodies);
  void couple(int a, int b);
  void end();

  /// The same of all bodies that act on each other, by way of others, too.
  int group_of(int body) const { return groups_[body]; }

  void clear_matrix();
  /// Of bodies that are the same or act on each other.
  Matrix6& block(int row, int column);
  Vector6& load(int body) { return loads_[body]; }
  const Vector6& solution(int body) const { return solution_[body]; }
  /// The largest numbers beside the diagonal blocks' displacements and rotations.
  double largest_resistance() const;
  double largest_turning_resistance() const;
  void factor();
  void solve();
  double work() const;  ///< of the loads along the solution

 private:
  using Couple = std::pair<int, int>;  ///< of bodies, the lower one first
  void find_order();

  std::vector<Couple> couples_, last_couples_;  ///< ascending, each once
  int bodies_ = -1;
  std::vector<int> groups_;              ///< by body: the last one of its group in that order
  std::vector<int> order_;               ///< in which bodies are eliminated
  std::vector<std::vector<int>> later_;  ///< by body: those that are eliminated after it and that it then acts on, ascending
  /// By body: places in `blocks_` of the rows and columns that it and those have in common, one pair for each of these
  std::vector<std::vector<std::pair<int, int>>> places_;
  std::vector<Matrix6> blocks_;                         ///< the diagonal ones first
  std::vector<Eigen::PartialPivLU<Matrix6>> pivots_;    ///< by body
  std::vector<Vector6> loads_, solution_, eliminated_;  ///< by body
};

}  // namespace verlet_cable

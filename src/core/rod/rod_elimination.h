#pragma once

#include <Eigen/LU>
#include <vector>

#include "rod/block_elimination.h"
#include "rod/rod_joints.h"

namespace verlet_cable {

/// What a KktSystem has beside of a rod of material frames: the rotations of its segments,
///   w = direction x (x_(i+1) - x_i) / |direction|² + axis tau,
/// so that displacements alone turn them without twist.
struct RodStiffness {
  SymmetricArray segment;             ///< n: against a segment's own rotation, but for the joints between segments [N m]
  std::vector<double> force_density;  ///< n: the tension over length, as far as it turns with the segment [N/m]
  double turning_part = 0;            ///< how much of the joints' moments turns with the segments
  std::vector<double> torque;         ///< n: what is out of balance about the directions [N m]

  void resize(int segments);
};

/// Solves the KktSystem of a rod of material frames directly, in O(n), from both ends at once. What lies behind a cut is
/// condensed to how its end gives way to a force f and the rotation w of its last segment, and how that resists:
///   x = A f + B w + a,   C w - B^T f = s,
/// which holds for held ends (A = 0) and free ones, and needs pivots of 3 x 3 only. A node of inertia and stiffness M behind the
/// cut makes A of it (A^-1 + M)^-1.
class RodElimination {
 public:
  void resize(int segments);
  /// Factorises the matrix; zero in `joints` where segments do not meet. False if it is not positive definite on what keeps the
  /// lengths.
  bool factor(const KktSystem& system, const RodStiffness& stiffness, const RodJoints& joints);
  /// Solves for `load` and `gap` of the system and `torque`, with the last factorisation.
  void solve(const KktSystem& system, const std::vector<double>& torque);

  KktSolution& solution() { return solution_; }
  const VectorArray& displacement() const { return solution_.displacement; }      ///< nodes
  const std::vector<double>& multiplier() const { return solution_.multiplier; }  ///< segments
  const std::vector<double>& twist() const { return solution_.twist; }            ///< segments: tau [rad]
  const VectorArray& force() const { return solution_.force; }  ///< segments: on the first node [N], without what the loads had

 private:
  /// A segment, the node after it and the joint there, eliminated.
  struct Elimination {
    PairVector direction, axis;
    PairSymmetric give;       ///< A
    PairMatrix turned;        ///< B
    PairSymmetric inertia;    ///< M
    PairSymmetric pivot;      ///< inverse of C and the joint
    PairMatrix turned_pivot;  ///< B times that
    PairMatrix carried;       ///< the pivot times the coupling to the next segment
    PairVector stretch_turn;  ///< moment of the segment's own stiffness against a stretch
    PairSymmetric across;     ///< the added coupling of its two nodes, its symmetric part
    PairVector skew;          ///< and the rest: that of the node after it, x, and its change d is x . (skew x d)
    PairVector lever;         ///< direction x skew: what a stretch does to that node
    Pair inverse_square, gap_share, stretch, force_density;
  };
  struct Forward {
    PairVector load, give, moment;
  };
  /// A held node between the ends.
  struct HeldInside {
    int step;                 ///< of the elimination
    Pair free;                ///< 0 where it is the lane's
    PairSymmetric stiffness;  ///< A^-1
    PairMatrix turned;        ///< that times B
    PairVector force;         ///< that times a
  };
  using Middle = Eigen::Matrix<double, 9, 9>;
  using MiddleVector = Eigen::Matrix<double, 9, 1>;

  template <bool stiffened>
  PairSymmetric ends(const KktSystem& system) const;
  PairVector held_ends(const KktSystem& system) const;
  template <bool stiffened>
  bool factor_lanes(const KktSystem& system, const RodStiffness& stiffness, const RodJoints& joints);
  template <bool stiffened>
  void solve_lanes(const KktSystem& system, const std::vector<double>& torque);

  int segments_ = 0;
  int padded_ = 0;  ///< segments, made even by one that hangs on to the last node
  bool stiffened_ = false;
  std::vector<double> inertia_;            ///< nodes, padded
  std::vector<double> mobility_;           ///< of the two ends: left, right; 0 where held [m/N]
  std::vector<Elimination> eliminations_;  ///< padded_ / 2
  std::vector<Forward> forward_;
  std::vector<HeldInside> held_inside_;
  Eigen::PartialPivLU<Middle> middle_;
  KktSolution solution_;
};

}  // namespace verlet_cable

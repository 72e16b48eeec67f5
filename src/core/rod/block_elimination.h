#pragma once

#include <vector>

#include "chain/cable_point.h"
#include "geometry/vector_array.h"
#include "rod/node_elimination.h"
#include "rod/pair.h"

namespace verlet_cable {

/// The linear system of one Newton iteration of a cable: displacements of its N nodes together with the multipliers of its n = N
/// - 1 segments. For node i and segment i (`p` is `direction`):
///
///   diagonal_i x_i + first_i x_(i+1) + first_(i-1) x_(i-1) + second_i x_(i+2) + second_(i-2) x_(i-2)
///       - p_i m_i + p_(i-1) m_(i-1) = load_i,     or x_i = 0 where movable_i is 0
///   p_i . (x_(i+1) - x_i) - compliance_i m_i = gap_i
///
/// and where what holds nodes moves, too, x_i = held_displacement_i there;
/// and where something else resists the motion, symmetric blocks `added` to the diagonal and any `added_next` to the coupling of
/// node i, whose rows these are, and i + 1.
struct KktSystem {
  std::vector<double> diagonal;    ///< N
  std::vector<double> movable;     ///< N, 1 or 0
  std::vector<double> first;       ///< n
  std::vector<double> second;      ///< N, the last two unused; all zero where nothing bends
  VectorArray direction;           ///< n
  std::vector<double> compliance;  ///< n, >= 0
  VectorArray load;                ///< N
  std::vector<double> gap;         ///< n
  /// Where material flows through guides: what their equations lack [N], one a flow; see CableStepper::let_flow
  std::vector<double> flow_load;
  bool moves_held = false;        ///< whether held nodes are displaced
  VectorArray held_displacement;  ///< N, read where movable is 0
  bool stiffened = false;         ///< whether there are added blocks
  SymmetricArray added;           ///< N
  MatrixArray added_next;         ///< n

  void resize(int segments);
  void clear_stiffness();
  /// Adds a symmetric stiffness that resists the motion of a point.
  void add_stiffness(const CablePoint& point, const Eigen::Matrix3d& stiffness);
  /// What the added couplings to its neighbours make of a displacement, at a node.
  Vector3 added_load(int node, const VectorArray& displacement) const;
};

/// Of a KktSystem.
struct KktSolution {
  VectorArray displacement;        ///< N
  std::vector<double> multiplier;  ///< n
  // Of a rod of material frames, too
  VectorArray force;          ///< n, on the first nodes
  std::vector<double> twist;  ///< n

  void resize(int segments);
  void add(const KktSolution& other);
};

/// Solves a KktSystem directly, in O(n): elimination of blocks of one node and the multiplier before it, from both ends at
/// once (a twisted factorisation). Each multiplier comes after both its nodes or with the second, so that no pivot vanishes at a
/// held end.
class BlockElimination {
 public:
  void resize(int segments);
  /// Factorises the matrix; `bending`: whether `second` is used.
  void factor(const KktSystem& system, bool bending);
  /// Solves for the right-hand sides `load` and `gap` with the last factorisation.
  void solve(const KktSystem& system);

  /// Replaces the solution.
  void set_solution(const VectorArray& displacement, const std::vector<double>& multiplier);

  KktSolution& solution() { return solution_; }
  const VectorArray& displacement() const { return solution_.displacement; }      ///< N
  const std::vector<double>& multiplier() const { return solution_.multiplier; }  ///< n

 private:
  template <Couplings couplings>
  void factor_lanes(const KktSystem& system);
  template <Couplings couplings>
  void solve_lanes(const VectorArray& load, const std::vector<double>& gap);
  void load_by_held(const KktSystem& system);

  int nodes_ = 0;                                ///< even: padded by a held one where necessary
  int lane_ = 0;                                 ///< eliminations from either end; two nodes are left in the middle
  Couplings couplings_ = Couplings::plain;       ///< of the last factorisation
  std::vector<Elimination<Pair>> eliminations_;  ///< lane_
  std::vector<Forward<Pair>> forward_;           ///< lane_
  MiddleElimination middle_;
  KktSolution solution_;
  // Right-hand sides with what displaced nodes add to them
  VectorArray load_;
  std::vector<double> gap_;
};

}  // namespace verlet_cable

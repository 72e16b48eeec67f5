#pragma once

#include <vector>

#include "contact/law.h"
#include "rod/participant.h"
#include "rod/work_budget.h"

namespace verlet_cable {

/// What contacts couple beyond the cables' own matrices: segments far from each other, other cables. Solved by conjugate
/// gradients with the cables' direct solutions as preconditioner, so that every iterate keeps the lengths (Gould, Hribar and
/// Nocedal, On the Solution of Equality Constrained Quadratic Programming Problems Arising in Optimization, 2001).
class CoupledContacts {
 public:
  void begin(std::size_t participants);  ///< a substep
  void clear() { couplings_.clear(); }
  bool empty() const { return couplings_.empty(); }
  /// A touch of two participants, whose matrices have its stiffness [N/m] already.
  void add(const Touch& touch, int first, int second, const Eigen::Matrix3d& stiffness);
  /// Improves the solutions that the cables have found alone until they heed each other. The matrix differs from the cables' own
  /// by what joins the two sides of contacts, so that all residuals are forces on their points. `negligible_energy` [J]: of a
  /// correction that moves no node by more than what is tolerated.
  void solve(double negligible_energy, WorkCount& work, std::vector<Participant>& participants);

 private:
  struct Cable {
    bool coupled = false;
    // Its own loads meanwhile, and none while it has its own
    VectorArray load;               // nodes [N]
    std::vector<double> gap;        // segments [m^2]
    std::vector<double> torque;     // of a whole rod: segments [N m]
    std::vector<double> flow_load;  // one a flow through a guide [N]
    VectorArray kept_load;          // nodes [N]: as it was before contacts added to it
    // The solution so far and the direction in which it is improved
    VectorArray correction, direction;                     // nodes [m]
    std::vector<double> multiplier, multiplier_direction;  // segments [N/m]
  };

  /// One side of a contact: of forces and displacements at its point alone. Forces on other points of the cables are none.
  struct Side {
    int participant = 0;
    CablePoint point;
    Vector3 residual = Vector3::Zero();      ///< [N]
    Vector3 displacement = Vector3::Zero();  ///< [m] that the cables alone make of the residuals
    Vector3 direction = Vector3::Zero();     ///< [m]
    Vector3 image = Vector3::Zero();         ///< [N] the cables' own matrices times the direction
    Vector3 correction = Vector3::Zero();    ///< [N] with which the cables' own matrices make the whole solution
  };

  /// What the matrix has of a contact beyond the cables' own blocks.
  struct Coupling {
    Side first, second;
    Eigen::Matrix3d matrix;
  };

  static Side side_at(const CablePoint& point, int participant);
  double precondition(std::vector<Participant>& participants);
  void turn_directions(double last_step, double ratio, const std::vector<Participant>& participants);
  void load_residuals(std::vector<Participant>& participants) const;
  void begin_solutions(const std::vector<Participant>& participants);
  void exchange_loads(std::vector<Participant>& participants);
  void clear_loads(std::vector<Participant>& participants) const;
  void put_solutions(double last_step, std::vector<Participant>& participants);
  void solve_whole_rods(std::vector<Participant>& participants);

  std::vector<Cable> cables_;  ///< one a participant
  std::vector<Coupling> couplings_;
  double largest_energy_ = 0;  ///< [J] of a correction in this substep
};

}  // namespace verlet_cable

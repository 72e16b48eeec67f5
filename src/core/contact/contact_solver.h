#pragma once

#include <vector>

#include "body/body_system.h"
#include "contact/law.h"
#include "rod/participant.h"
#include "rod/work_budget.h"

namespace verlet_cable {

/// Advances cables that touch something by one substep, together. Newton's method on all of them at once: each cable's own
/// matrix, with what contacts add to it, is solved directly; what contacts couple beyond that (segments far from each other,
/// other cables) by conjugate gradients with those direct solutions as preconditioner, so that every iterate keeps the lengths
/// (Gould, Hribar and Nocedal, On the Solution of Equality Constrained Quadratic Programming Problems Arising in Optimization,
/// 2001).
class ContactSolver {
 public:
  /// If it has not converged, `converged` is false in the result of the participant that failed. The states are untouched.
  /// `bodies`: that hold or touch some of them, and have begun; none where it is null. Gives up after `most_work`, see `budget`.
  bool solve(std::vector<Participant>& participants, std::vector<Touch>& touches, BodySystem* bodies, double most_work);
  /// Whether segments that touch pass through each other in what has been found.
  bool crosses(const std::vector<Participant>& participants, const std::vector<Touch>& touches) const;
  /// The states and the contacts take what has been found.
  void finish(std::vector<Participant>& participants, std::vector<Touch>& touches) const;
  double work() const { return spent_; }  ///< of the last `solve`, see `budget`

 private:
  /// One participant, in the conjugate gradients.
  struct Work {
    bool coupled = false, slips = false;
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

  /// One side of a contact, in the conjugate gradients: of forces and displacements at its point alone. Forces on other points
  /// of the cables are none.
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

  /// A contact whose friction follows the normal force: it slides, or leans at an edge.
  struct Slip {
    Touch* touch = nullptr;
    int participant = 0;
    Vector3 normal, friction;                ///< the second: over the normal force
    double normal_force = 0, stiffness = 0;  ///< [N], [N/m] of it
    double change = 0;                       ///< [N] of it, in the correction
    Vector3 displacement = Vector3::Zero();  ///< [m] likewise
  };

  void begin(std::vector<Participant>& participants);
  void spend(double visits, std::size_t contacts) { spent_ += visits * size_ + budget::touch * static_cast<double>(contacts); }
  bool iterate(std::vector<Participant>& participants, std::vector<Touch>& touches);
  bool press(std::vector<Participant>& participants, std::vector<Touch>& touches);
  void hold_bounds(std::vector<Touch>& touches) const;
  bool shorten(std::vector<Participant>& participants, std::vector<Touch>& touches);
  double work_along(std::vector<Participant>& participants) const;
  double missing_energy(const std::vector<Participant>& participants) const;
  double work_from_outside(const std::vector<Participant>& participants, const std::vector<Touch>& touches) const;
  void factor(std::vector<Participant>& participants, std::vector<Touch>& touches);
  void couple(std::vector<Participant>& participants);
  void follow_friction(std::vector<Participant>& participants, std::vector<Touch>& touches);
  double follow_slips(std::vector<Participant>& participants);
  void solve_slipping(std::vector<Participant>& participants);
  void exchange_loads(std::vector<Participant>& participants);
  void begin_solutions(const std::vector<Participant>& participants);
  void clear_loads(std::vector<Participant>& participants) const;
  double precondition(std::vector<Participant>& participants);
  void turn_directions(double last_step, double ratio, const std::vector<Participant>& participants);
  void put_solutions(double last_step, std::vector<Participant>& participants);
  void load_residuals(std::vector<Participant>& participants) const;
  void solve_whole_rods(std::vector<Participant>& participants);
  Vector3 displacement_of(Touch& touch, std::vector<Participant>& participants) const;
  Participant& at(std::vector<Participant>& participants, const CablePoint& point) const;
  Side side_at(const CablePoint& point) const;

  BodySystem* bodies_ = nullptr;
  std::vector<int> index_;  ///< of the participant, by cable
  std::vector<Work> work_;  ///< one a participant
  std::vector<Coupling> couplings_;
  std::vector<Slip> slips_;
  double tolerated_ = 0;          ///< [m] of a node
  double work_along_ = 0;         ///< [J] of the forces along the last correction, where it begins
  double negligible_energy_ = 0;  ///< [J] moves no node by more than what is tolerated
  double largest_energy_ = 0;     ///< of a correction in this substep
  double size_ = 0;               ///< work of visiting all segments once
  double spent_ = 0;              ///< work so far
  double most_work_ = 0;
};

}  // namespace verlet_cable

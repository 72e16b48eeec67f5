#pragma once

#include <vector>

#include "contact/law.h"
#include "rod/cable_stepper.h"

namespace verlet_cable {

/// A cable that takes part in a substep.
struct Participant {
  int place = 0;  ///< in its group
  int cable = 0;  ///< as in CablePoint
  CableStepper* stepper = nullptr;
  Substep substep;
  CableState* state = nullptr;
  SubstepResult result;
};

/// Advances cables that touch something by one substep, together. Newton's method on all of them at once: each cable's own
/// matrix, with what contacts add to it, is solved directly; what contacts couple beyond that (segments far from each other,
/// other cables) by conjugate gradients with those direct solutions as preconditioner, so that every iterate keeps the lengths
/// (Gould, Hribar and Nocedal, On the Solution of Equality Constrained Quadratic Programming Problems Arising in Optimization,
/// 2001).
class ContactSolver {
 public:
  /// If it has not converged, the states are untouched, and `converged` is false in the result of the participant that failed.
  bool advance(std::vector<Participant>& participants, std::vector<Touch>& touches);

 private:
  /// Of one participant, for the conjugate gradients; their residual is in the load of its system.
  struct Work {
    VectorArray load;                   // nodes: the system's own
    std::vector<double> gap;            // segments: likewise
    VectorArray correction, direction;  // nodes
    VectorArray own_image, image;       // nodes: the matrix times the direction, `own` without couplings
    std::vector<double> correction_multiplier, direction_multiplier;  // segments
    std::vector<double> torque, correction_twist, direction_twist;    // of a whole rod: segments

    void resize(std::size_t nodes);
  };

  /// What the matrix has of a contact beyond the cables' own blocks.
  struct Coupling {
    int first = 0, second = 0;  ///< participants
    int first_segment = 0, second_segment = 0;
    double first_fraction = 0, second_fraction = 0;
    Eigen::Matrix3d matrix;
  };

  bool solve(std::vector<Participant>& participants, std::vector<Touch>& touches);
  bool press(std::vector<Participant>& participants, std::vector<Touch>& touches);
  bool shorten(std::vector<Participant>& participants, std::vector<Touch>& touches);
  double work_along(std::vector<Participant>& participants) const;
  void factor(std::vector<Participant>& participants, std::vector<Touch>& touches);
  void couple(std::vector<Participant>& participants);
  template <typename Of, typename To>
  void add_coupling(double sign, const Of& of, const To& to) const;
  Participant& at(std::vector<Participant>& participants, const CablePoint& point) const;

  std::vector<int> index_;  ///< of the participant, by cable
  std::vector<Work> work_;  ///< one a participant
  std::vector<Coupling> couplings_;
  double work_along_ = 0;         ///< [J] of the forces along the last correction, where it begins
  double negligible_energy_ = 0;  ///< [J] moves no node by more than what is tolerated
  double largest_energy_ = 0;     ///< of a correction in this substep
};

}  // namespace verlet_cable

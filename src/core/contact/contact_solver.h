#pragma once

#include <vector>

#include "body/body_system.h"
#include "contact/coupled_contacts.h"
#include "contact/following_friction.h"
#include "contact/law.h"
#include "rod/participant.h"
#include "rod/work_budget.h"

namespace verlet_cable {

/// Advances cables that touch something by one substep, together. Newton's method on all of them at once: each cable's own
/// matrix, with what contacts add to it, is solved directly; see CoupledContacts for what they couple beyond that.
class ContactSolver {
 public:
  /// If it has not converged, `converged` is false in the result of the participant that failed. The states are untouched.
  /// `bodies`: that hold or touch some of them, and have begun; none where it is null. Gives up after `most_work`, see `budget`.
  bool solve(std::vector<Participant>& participants, std::vector<Touch>& touches, BodySystem* bodies, double most_work);
  /// Whether segments that touch pass through each other in what has been found.
  bool crosses(const std::vector<Participant>& participants, const std::vector<Touch>& touches) const;
  /// The states and the contacts take what has been found.
  void finish(std::vector<Participant>& participants, std::vector<Touch>& touches) const;
  double work() const { return work_.spent; }  ///< of the last `solve`, see `budget`

 private:
  void begin(std::vector<Participant>& participants);
  bool iterate(std::vector<Participant>& participants, std::vector<Touch>& touches);
  bool press(std::vector<Participant>& participants, std::vector<Touch>& touches);
  void hold_bounds(std::vector<Touch>& touches) const;
  bool shorten(std::vector<Participant>& participants, std::vector<Touch>& touches);
  double work_along(std::vector<Participant>& participants) const;
  double missing_energy(const std::vector<Participant>& participants) const;
  double work_from_outside(const std::vector<Participant>& participants, const std::vector<Touch>& touches) const;
  void factor(std::vector<Participant>& participants, std::vector<Touch>& touches);
  Vector3 displacement_of(Touch& touch, std::vector<Participant>& participants) const;
  Participant& at(std::vector<Participant>& participants, const CablePoint& point) const;

  BodySystem* bodies_ = nullptr;
  std::vector<int> index_;  ///< of the participant, by cable
  CoupledContacts coupled_;
  FollowingFriction friction_;
  double work_along_ = 0;  ///< [J] of the forces along the last correction, where it begins
  WorkCount work_;
};

}  // namespace verlet_cable

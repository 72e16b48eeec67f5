#pragma once

#include <vector>

#include "body/body_contacts.h"
#include "body/body_equations.h"
#include "body/body_joints.h"
#include "body/held_cable.h"
#include "body/moving_body.h"
#include "rod/participant.h"

namespace verlet_cable {

/// A body that takes part in a substep.
struct BodyMember {
  int body = 0;  ///< index into State::bodies
  const SimulatedBody* start = nullptr;
  const BodyProgress* progress = nullptr;
};

/// Advances bodies, and the cables that they hold, by one substep, in one system: see HeldCable and BodyJoints.
class BodySystem {
 public:
  /// `participants`: cables, of which those that bodies hold have steppers that have begun. Joints are to be set after it.
  void begin(const std::vector<BodyMember>& members, const std::vector<Participant>& participants,
             const std::vector<SimulatedBody>& bodies, const std::vector<Load>& loads, const Environment& environment,
             const SubstepRules& rules);
  std::vector<BodyJoint>& joints() { return joints_.all(); }
  const std::vector<BodyJoint>& joints() const { return joints_.all(); }
  BodyContacts& contacts() { return contacts_; }
  const BodyContacts& contacts() const { return contacts_; }
  double substep() const { return rules_.h; }   ///< [s]
  int solutions() const { return solutions_; }  ///< of the linear system, since it began
  /// Index among the members of a body, by its own; -1: it is none.
  int member_of(int body) const { return member_of_[body]; }

  /// If it has not converged, states are untouched, and nothing is to be finished.
  bool advance(std::vector<Participant>& participants, double tolerance);

  // Contacts of a body with the cable of a participant that touches it, as they are linearised
  void clear_cable_contacts();
  void add_cable_contact(int participant, const Touch& touch);

  // The stages of an iteration
  void place_holders(std::vector<Participant>& participants);  ///< before cables are evaluated
  /// After cables are solved with their holders in place; `stale`: they have been factorised since.
  void solve(std::vector<Participant>& participants, bool stale);
  /// The largest displacement of a body in parts of its size, or rotation [rad].
  double correct();
  void take_back(double part);  ///< of the last correction
  /// [J] Of what is out of balance at bodies along the last correction.
  double work_along(const std::vector<Participant>& participants);

  /// Impulses along inextensible segments and in joints that end all velocities that these do not allow, once bodies and cables
  /// have finished; without them such velocities would alternate from step to step.
  void project(std::vector<Participant>& participants, std::vector<SimulatedBody>& bodies, std::vector<BodyProgress>& progress);

  /// The cables' boundaries get what bodies have come to, and joints have exerted what they do.
  void place_at_end(std::vector<Participant>& participants);
  /// Substeps that damp keep the momenta of what no frame holds to second order; once bodies and cables have finished, what is
  /// missing is given back as a rigid body's motion.
  void restore_momenta(std::vector<Participant>& participants, std::vector<SimulatedBody>& bodies);
  double largest_displacement() const;  ///< [m] over the substep, of a body's center of mass or what turns with its size
  double damping_work(int member) const { return members_[member].stepper.damping_work(); }  ///< [J] over the substep
  double applied_work(int member) const { return members_[member].stepper.applied_work(); }  ///< [J] likewise
  /// Adds what the fluid does to it over the substep.
  void add_fluid_work(int member, EnergyBalance& balance) const { members_[member].stepper.add_fluid_work(balance); }
  void finish(int member, SimulatedBody& body, BodyProgress& progress) const;

 private:
  void find_cables(const std::vector<Participant>& participants);
  void find_couples();
  bool keeps_momenta() const { return !rules_.statics && rules_.scheme != Scheme::conserving; }
  void expect_momenta(const std::vector<Participant>& participants);
  GroupMomenta& group_of(int member) { return momenta_[equations_.group_of(member)]; }
  void evaluate(bool stale);
  bool lacks_energy(const std::vector<Participant>& participants, const Convergence& convergence) const;
  void condense(std::vector<Participant>& participants);
  void add_loads();
  void add_inertia();
  void add_impulses(std::vector<Participant>& participants);

  SubstepRules rules_;
  std::vector<int> member_of_;
  std::vector<MovingBody> members_;
  std::vector<HeldCable> cables_;  ///< as many of them as there are
  std::size_t cable_count_ = 0;
  int solutions_ = 0;
  std::vector<int> cable_of_;  ///< by participant; -1: no body has to do with it
  BodyJoints joints_;
  BodyContacts contacts_;
  BodyEquations equations_;
  std::vector<GroupMomenta> momenta_;  ///< by BodyEquations::group_of
};

}  // namespace verlet_cable

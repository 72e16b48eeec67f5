#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <array>
#include <vector>

#include "body/rigid_body_stepper.h"
#include "rod/participant.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// A body that takes part in a substep.
struct BodyMember {
  int body = 0;  ///< index into State::bodies
  const SimulatedBody* start = nullptr;
  const BodyProgress* progress = nullptr;
};

/// What holds a body, over a substep.
struct BodyJoint {
  int attachment = 0;  ///< index into World::attachments()
  AttachmentType type = AttachmentType::hinge;
  int member = 0;                    ///< index of the body that is held, among the members
  Pose at;                           ///< on that body
  int other = -1;                    ///< likewise of the one that holds it; -1: a frame does
  FrameVelocity holder_velocity;     ///< of a frame\'s attachment, at the end of the substep
  Pose holder;                       ///< of the attachment at the end of the substep, in the fixed frame or on the other body
  Vector3 force = Vector3::Zero();   ///< [N] on the body that is held
  Vector3 torque = Vector3::Zero();  ///< [N m] likewise, about the attachment's point
  Vector3 force_change = Vector3::Zero(), torque_change = Vector3::Zero();  ///< in the last correction
};

/// Advances bodies, and the cables that they hold, by one substep, in one system. Each cable is eliminated onto the bodies
/// that hold it (substructuring; Przemieniecki, Matrix Structural Analysis of Substructures, 1963): it tells what it exerts on
/// them, and how that changes as they move; then they are solved for together, and the cables follow them. What holds bodies acts
/// through multipliers that grow with the gap that is left (the method of multipliers; Hestenes 1969), which ends as exact as
/// without, and may hold a body more than once.
class BodySystem {
 public:
  /// `participants`: cables, of which those that bodies hold have steppers that have begun.
  void begin(const std::vector<BodyMember>& members, const std::vector<Participant>& participants,
             const std::vector<SimulatedBody>& bodies, const GravityDesc& gravity, const SubstepRules& rules);
  std::vector<BodyJoint>& joints() { return joints_; }

  /// If it has not converged, states are untouched, and nothing is to be finished.
  bool advance(std::vector<Participant>& participants, double tolerance);

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

  /// The cables' boundaries get what bodies have come to.
  void place_at_end(std::vector<Participant>& participants);
  double largest_displacement() const;  ///< [m] over the substep, of a body's center of mass or what turns with its size
  void finish(int member, SimulatedBody& body, BodyProgress& progress) const;

 private:
  /// A node or direction of a cable that a body holds.
  struct Side {
    int member = 0;
    int entry = 0;  ///< of the boundary's nodes or directions
    bool turns = false;
    Vector3 point = Vector3::Zero();  ///< of a node
  };
  struct HeldCable {
    int participant = 0;
    std::vector<Side> sides;
    Eigen::MatrixXd resistance;  ///< of what the sides feel against how they move
    HolderLoads loads, responses;
    HolderMotion motion;
  };
  struct Member {
    RigidBodyStepper stepper;
    MassProperties whole;
    double size = 0;  ///< [m] of it
  };

  void find_sides(const std::vector<Participant>& participants);
  void gather_mass(const SimulatedBody& body, int member, const std::vector<Participant>& participants);
  static Eigen::Matrix<double, 3, 6> motion_of(const Side& side, const RigidBodyStepper& stepper);
  using LoadOf = Eigen::Matrix<double, 6, 3> (*)(const Side& side, const RigidBodyStepper& stepper);
  static Eigen::Matrix<double, 6, 3> load_of(const Side& side, const RigidBodyStepper& stepper);     ///< of a force
  static Eigen::Matrix<double, 6, 3> impulse_of(const Side& side, const RigidBodyStepper& stepper);  ///< at the end
  void gather_loads();
  void condense(std::vector<Participant>& participants);
  void add_resistance(HeldCable& cable, Participant& participant, LoadOf load_of);
  void project_joint(const BodyJoint& joint);
  void move_sides(HeldCable& cable) const;
  void find_holding();
  void add_turning(int member, const Vector3& point, const Vector3& force);
  void add_joint(BodyJoint& joint, bool stiffness);
  Vector3 gap_of(const BodyJoint& joint) const;
  Vector3 turn_of(const BodyJoint& joint) const;
  Eigen::Matrix3d held_turns_of(const BodyJoint& joint) const;

  SubstepRules rules_;
  std::vector<int> place_;  ///< of a body among the members, by its index
  std::vector<Member> members_;
  std::vector<HeldCable> cables_;
  std::size_t cable_count_ = 0;
  std::vector<BodyJoint> joints_;
  double holding_ = 0, holding_turn_ = 0;  ///< [N/m], [N m] of the joints' multipliers against gaps
  Eigen::MatrixXd matrix_;
  Eigen::VectorXd load_, change_;
  Eigen::PartialPivLU<Eigen::MatrixXd> solver_;
};

}  // namespace verlet_cable

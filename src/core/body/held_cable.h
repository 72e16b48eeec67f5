#pragma once

#include <Eigen/Core>
#include <vector>

#include "body/body_equations.h"
#include "body/moving_body.h"
#include "contact/law.h"
#include "rod/participant.h"

namespace verlet_cable {

/// A cable that bodies hold, eliminated onto those (substructuring; Przemieniecki, Matrix Structural Analysis of Substructures,
/// 1963): it tells what it exerts on them, and how that changes as they move; then they are solved for together, and the cable
/// follows them.
class HeldCable {
 public:
  /// `member_of`: of a body, by its index.
  void begin(int participant, const Participant& p, const std::vector<int>& member_of);
  /// Which bodies act on each other through the cable.
  void couple(BodyEquations& equations);
  int participant() const { return participant_; }
  int first_member() const { return sides_.front().member; }
  /// A body moves as one with the nodes that it holds.
  void add_masses(const Participant& p, std::vector<MovingBody>& bodies) const;

  void place_holders(const std::vector<MovingBody>& bodies, Boundary& boundary) const;
  void set_holder_velocities(const std::vector<MovingBody>& bodies, Boundary& boundary) const;
  bool is_held() const { return !sides_.empty(); }

  // Contacts with bodies that press, as they are linearised
  void clear_contacts() { contacts_.clear(); }
  void add_contact(const Touch& touch, int member);

  /// What the cable exerts on its holders; `corrected`: after the last solution.
  void read_loads(const Participant& p, bool corrected);
  void read_impulses(const Participant& p);
  void add_loads(const std::vector<MovingBody>& bodies, BodyStage stage, BodyEquations& equations) const;
  /// The torques of what it exerts change as bodies turn.
  void add_turning(double part, const std::vector<MovingBody>& bodies, BodyEquations& equations) const;
  /// And what it exerts as they move.
  void add_resistance(const std::vector<MovingBody>& bodies, BodyStage stage, Participant& p, BodyEquations& equations);
  /// The cable follows what has been solved for.
  void follow(const std::vector<MovingBody>& bodies, const BodyEquations& equations, Participant& p);
  /// Of the nodes that bodies do not hold: what forces leave of their momenta, and what they have at the end.
  static void expect_momenta(const Participant& p, GroupMomenta& group);
  static void add_momenta(const Participant& p, GroupMomenta& group);
  static void add_motion(const RigidMotion& motion, Participant& p);
  /// [J] Of its loads along its own solution, what nodes that move with bodies have of that.
  double work_of_held(const Participant& p) const;

 private:
  /// A node or direction that a body holds.
  struct Side {
    int member = 0;
    int node = 0;
    int entry = 0;  ///< of the boundary's nodes or directions
    bool turns = false;
    Vector3 point = Vector3::Zero();  ///< of a node
    /// Of the cable, between places across which nothing is felt: those that feel how the side moves.
    int first_stretch = 0, last_stretch = 0;
    int first_other = 0, past_others = 0;  ///< of the sides that feel how it moves; it feels how these move
    int first_block = 0;                   ///< of `resistance_`: what it feels of those, in their order
    int turn = 0;                          ///< sides of the same one are moved at once: none feels two of them
  };
  static Matrix36 motion_of(const Side& side, const RigidBodyStepper& body);
  static Matrix63 load_of(const Side& side, const RigidBodyStepper& body, BodyStage stage);
  /// A contact with a body.
  struct Contact {
    const Touch* touch = nullptr;
    int member = 0;
    Eigen::Matrix3d stiffness;         ///< [N/m] as the cable's system has it
    Eigen::Matrix3d resistance;        ///< [N/m] against motion of the body; friction follows the normal force
    Vector3 change = Vector3::Zero();  ///< [N] of its force on the body, in the last correction
  };
  void add_touching_resistance(const std::vector<MovingBody>& bodies, BodyStage stage, Participant& p, BodyEquations& equations);
  Vector3& motion_of(const Side& side) { return side.turns ? motion_.rotations[side.entry] : motion_.displacements[side.entry]; }
  static const Vector3& load_of(const Side& side, const HolderLoads& loads) {
    return side.turns ? loads.torques[side.entry] : loads.forces[side.entry];
  }
  void find_stretches(const Participant& p);
  void find_others();
  void share_turns();
  Eigen::Matrix3d& resistance(const Side& of, int against) { return resistance_[of.first_block + against - of.first_other]; }
  void find_resistance(BodyStage stage, Participant& p);

  int participant_ = 0;
  std::vector<Side> sides_;  ///< ascending by node, a node before its direction
  std::vector<Contact> contacts_;
  std::vector<int> members_;                 ///< bodies that hold it or press on it, ascending; set by `couple`
  std::vector<int> turns_;                   ///< of each: past the last side that feels a side of it so far
  std::vector<Eigen::Matrix3d> resistance_;  ///< of what the sides feel, against how they move
  HolderLoads loads_, responses_;
  HolderMotion motion_;
};

}  // namespace verlet_cable

#pragma once

#include <array>
#include <vector>

#include "body/body_equations.h"
#include "body/moving_body.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// What a joint exerts on the body that is held.
struct JointWrench {
  Vector3 force = Vector3::Zero();   ///< [N]
  Vector3 torque = Vector3::Zero();  ///< [N m] about the attachment's point
};

/// What holds a body, over a substep.
struct BodyJoint {
  int attachment = 0;  ///< index into World::attachments()
  AttachmentType type = AttachmentType::hinge;
  int member = 0;                 ///< index of the body that is held, among the members
  Pose at;                        ///< on that body
  int other = -1;                 ///< likewise of the one that holds it; -1: a frame does
  FrameVelocity holder_velocity;  ///< of a frame's attachment, at the end of the substep
  Pose holder;                    ///< of the attachment at the end of the substep, in the fixed frame or on the other body
  /// [N], [N m] its multipliers: what it exerts on the body that is held, where forces are taken
  Vector3 force = Vector3::Zero(), torque = Vector3::Zero();
  Vector3 force_change = Vector3::Zero(), torque_change = Vector3::Zero();  ///< in the last correction
  JointWrench exerted;  ///< out: all that it does to velocities, mean over the substep
  JointWrench mending;  ///< out: the part of it that mends them at the end
  JointWrench lasting;  ///< what accelerations come of, in at the start and out at the end; see mean_force
};

/// The joints of bodies over a substep: they act through multipliers that grow with the gap that is left (the method of
/// multipliers; Hestenes 1969), which ends as exact as without, and may hold a body more than once.
class BodyJoints {
 public:
  std::vector<BodyJoint>& all() { return joints_; }
  const std::vector<BodyJoint>& all() const { return joints_; }

  /// Which bodies act on each other through joints.
  void couple(BodyEquations& equations) const;
  /// Adds how joints resist, `part` of the substep being where forces are taken; all else is in the equations.
  void add_stiffness(double part, const std::vector<MovingBody>& bodies, BodyEquations& equations);
  void add_loads(const std::vector<MovingBody>& bodies, BodyEquations& equations) const;
  /// Lets joints end the velocities that they do not allow; matrix and loads. The inertia of bodies is in the equations, cables
  /// are not: what resists these impulses is mass, in all `mass` [kg], and taut cables would make it seem more than numbers can
  /// hold.
  void add_impulses(double mass, const std::vector<MovingBody>& bodies, BodyEquations& equations);
  /// Multipliers take over what the gaps that are left after the bodies' correction call for, which are not corrected yet.
  void correct(const std::vector<MovingBody>& bodies, const BodyEquations& equations);
  void take_back(double part);  ///< of the last correction
  /// What multipliers have done, once they are found.
  void exert(Scheme scheme);
  /// And impulses, once they are solved for, at the end of a substep of h [s].
  void exert_impulses(double h, const std::vector<MovingBody>& bodies, const BodyEquations& equations);

 private:
  /// The body that is held, or the other one.
  struct End {
    int member;
    double sign;
    Matrix63 load;
    Matrix36 motion;
  };
  struct Ends {
    std::array<End, 2> ends;
    int count = 0;
    const End* begin() const { return ends.data(); }
    const End* end() const { return ends.data() + count; }
  };
  /// What the matrix has of a joint, whose ends may have moved on since.
  struct Linearised {
    Ends ends;
    Eigen::Matrix3d held_turns;
  };
  static Ends ends_of(const BodyJoint& joint, const std::vector<MovingBody>& bodies, BodyStage stage);
  JointWrench impulse_of(const BodyJoint& joint, const std::vector<MovingBody>& bodies, const BodyEquations* solved) const;
  void set_holding(double resistance, const BodyEquations& equations);
  void add_resistance(const BodyJoint& joint, const Linearised& linearised, BodyEquations& equations) const;

  std::vector<BodyJoint> joints_;
  std::vector<Linearised> linearised_;     ///< one a joint
  double holding_ = 0, holding_turn_ = 0;  ///< [N/m], [N m] of the joints' multipliers against gaps
};

/// Adds by what the torque of a force on a body changes as that turns.
void add_turning(double part, const MovingBody& body, int member, const Vector3& point, const Vector3& force,
                 BodyEquations& equations);

}  // namespace verlet_cable

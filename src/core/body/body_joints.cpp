#include "body/body_joints.h"

namespace verlet_cable {

namespace {

/// Of joints, relative to what resists beside them: what is left of a gap after an iteration.
constexpr double holding_part = 1e7;

/// [m] From the point of the held body to where it is to be.
Vector3 gap_of(const BodyJoint& joint, const std::vector<MovingBody>& bodies) {
  const Vector3 place = joint.other < 0 ? joint.holder.position : bodies[joint.other].stepper.position_of(joint.holder.position);
  return place - bodies[joint.member].stepper.position_of(joint.at.position);
}

/// [rad] By what the held body is to turn.
Vector3 turn_of(const BodyJoint& joint, const std::vector<MovingBody>& bodies) {
  const Quaternion own = bodies[joint.member].stepper.pose().orientation * joint.at.orientation;
  const Quaternion wanted =
      joint.other < 0 ? joint.holder.orientation : bodies[joint.other].stepper.pose().orientation * joint.holder.orientation;
  if (joint.type == AttachmentType::axle) return (own * Vector3::UnitZ()).cross(wanted * Vector3::UnitZ());
  Quaternion turn = wanted * own.conjugate();
  return (turn.w() < 0 ? -2 : 2) * turn.vec();
}

bool holds_turns(const BodyJoint& joint) {
  return joint.type != AttachmentType::hinge;
}

/// Takes from a turn what a joint allows: an axle that about its axis.
Eigen::Matrix3d held_turns_of(const BodyJoint& joint, const std::vector<MovingBody>& bodies) {
  Eigen::Matrix3d held = Eigen::Matrix3d::Identity();
  if (joint.type != AttachmentType::axle) return held;
  const Vector3 axis = bodies[joint.member].stepper.pose().orientation * joint.at.orientation * Vector3::UnitZ();
  held -= axis * axis.transpose();
  return held;
}

}  // namespace

void add_turning(double part, const MovingBody& body, int member, const Vector3& point, const Vector3& force,
                 BodyEquations& equations) {
  equations.block(member, member).bottomRightCorner<3, 3>() -= part * turned_torque(body.stepper.end_arm(point), force);
}

/// What a joint exerts on the body that is held it exerts with the other sign on the other one.
BodyJoints::Ends BodyJoints::ends_of(const BodyJoint& joint, const std::vector<MovingBody>& bodies, BodyStage stage) {
  Ends all;
  const auto add = [&](int member, double sign, const Vector3& point) {
    const RigidBodyStepper& stepper = bodies[member].stepper;
    all.ends[all.count++] = {member, sign, sign * load_of(stepper, point, stage), sign * point_motion(stepper.end_arm(point))};
  };
  add(joint.member, 1, joint.at.position);
  if (joint.other >= 0) add(joint.other, -1, joint.holder.position);
  return all;
}

void BodyJoints::couple(BodyEquations& equations) const {
  for (const BodyJoint& joint : joints_)
    if (joint.other >= 0) equations.couple(joint.member, joint.other);
}

/// `resistance`: [kg/s^2] or [kg], to forces of joints.
void BodyJoints::set_holding(double resistance, const BodyEquations& equations) {
  holding_ = holding_part * resistance;
  holding_turn_ = holding_part * equations.largest_turning_resistance();
}

void BodyJoints::add_resistance(const BodyJoint& joint, const Linearised& linearised, BodyEquations& equations) const {
  for (const End& a : linearised.ends)
    for (const End& b : linearised.ends) {
      Matrix6& block = equations.block(a.member, b.member);
      block += holding_ * a.load * b.motion;
      if (holds_turns(joint)) block.bottomRightCorner<3, 3>() += holding_turn_ * a.sign * b.sign * linearised.held_turns;
    }
}

void BodyJoints::add_stiffness(double part, const std::vector<MovingBody>& bodies, BodyEquations& equations) {
  set_holding(equations.largest_resistance(), equations);
  linearised_.clear();
  for (const BodyJoint& joint : joints_) {
    add_turning(part, bodies[joint.member], joint.member, joint.at.position, joint.force, equations);
    if (joint.other >= 0) add_turning(part, bodies[joint.other], joint.other, joint.holder.position, -joint.force, equations);
    linearised_.push_back({ends_of(joint, bodies, BodyStage::substep), held_turns_of(joint, bodies)});
    add_resistance(joint, linearised_.back(), equations);
  }
}

void BodyJoints::add_loads(const std::vector<MovingBody>& bodies, BodyEquations& equations) const {
  for (const BodyJoint& joint : joints_) {
    const Vector3 force = joint.force + holding_ * gap_of(joint, bodies);
    Vector3 torque = Vector3::Zero();
    if (holds_turns(joint)) torque = held_turns_of(joint, bodies) * (joint.torque + holding_turn_ * turn_of(joint, bodies));
    for (const End& end : ends_of(joint, bodies, BodyStage::substep)) {
      equations.load(end.member) += end.load * force;
      equations.load(end.member).tail<3>() += end.sign * torque;
    }
  }
}

/// [N s], [N m s] Of velocities that it does not allow: those that bodies have come with, and once they are `solved` for, those
/// that are left.
JointWrench BodyJoints::impulse_of(const BodyJoint& joint, const std::vector<MovingBody>& bodies,
                                   const BodyEquations* solved) const {
  Vector3 gap = joint.holder_velocity.linear - bodies[joint.member].stepper.velocity_of(joint.at.position);
  Vector3 turning = joint.holder_velocity.angular - bodies[joint.member].stepper.spin();
  if (joint.other >= 0) {
    gap += bodies[joint.other].stepper.velocity_of(joint.holder.position);
    turning += bodies[joint.other].stepper.spin();
  }
  if (solved != nullptr)
    for (const End& end : ends_of(joint, bodies, BodyStage::projection)) {
      gap -= end.motion * solved->solution(end.member);
      turning -= end.sign * solved->solution(end.member).tail<3>();
    }
  JointWrench impulse;
  impulse.force = holding_ * gap;
  if (holds_turns(joint)) impulse.torque = holding_turn_ * (held_turns_of(joint, bodies) * turning);
  return impulse;
}

void BodyJoints::add_impulses(double mass, const std::vector<MovingBody>& bodies, BodyEquations& equations) {
  set_holding(mass, equations);
  for (const BodyJoint& joint : joints_) {
    const JointWrench impulse = impulse_of(joint, bodies, nullptr);
    const Ends ends = ends_of(joint, bodies, BodyStage::projection);
    for (const End& end : ends) {
      equations.load(end.member) += end.load * impulse.force;
      equations.load(end.member).tail<3>() += end.sign * impulse.torque;
    }
    add_resistance(joint, {ends, held_turns_of(joint, bodies)}, equations);
  }
}

void BodyJoints::correct(const std::vector<MovingBody>& bodies, const BodyEquations& equations) {
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    BodyJoint& joint = joints_[j];
    // As the equations had it: what they have balanced is what joints exert.
    Vector3 way = Vector3::Zero(), turn = Vector3::Zero();
    for (const End& end : linearised_[j].ends) {
      way += end.motion * equations.solution(end.member);
      turn += end.sign * equations.solution(end.member).tail<3>();
    }
    joint.force_change = holding_ * (gap_of(joint, bodies) - way);
    joint.force += joint.force_change;
    if (!holds_turns(joint)) continue;
    const Vector3 torque = held_turns_of(joint, bodies) * (joint.torque + holding_turn_ * turn_of(joint, bodies)) -
                           holding_turn_ * (linearised_[j].held_turns * turn);
    joint.torque_change = torque - joint.torque;
    joint.torque = torque;
  }
}

void BodyJoints::take_back(double part) {
  for (BodyJoint& joint : joints_) {
    joint.force -= part * joint.force_change;
    joint.torque -= part * joint.torque_change;
  }
}

void BodyJoints::exert(Scheme scheme) {
  for (BodyJoint& joint : joints_) {
    joint.exerted.force = mean_force(scheme, joint.force, joint.lasting.force);
    joint.exerted.torque = mean_force(scheme, joint.torque, joint.lasting.torque);
    joint.mending = {};
  }
}

void BodyJoints::exert_impulses(double h, const std::vector<MovingBody>& bodies, const BodyEquations& equations) {
  for (BodyJoint& joint : joints_) {
    const JointWrench impulse = impulse_of(joint, bodies, &equations);
    joint.mending.force = impulse.force / h;
    joint.mending.torque = impulse.torque / h;
    for (JointWrench* sum : {&joint.exerted, &joint.lasting}) {
      sum->force += joint.mending.force;
      sum->torque += joint.mending.torque;
    }
  }
}

}  // namespace verlet_cable

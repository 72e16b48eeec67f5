#include "body/body_contacts.h"

#include <algorithm>

namespace verlet_cable {

Matrix36 motion_on_body(const Touch& touch) {
  Matrix36 motion = point_motion(touch.arm);
  motion.rightCols<3>() += touch.point.along * touch.turning.transpose();
  return motion;
}

bool BodyContacts::is_stuck() const {
  return std::any_of(touches_.begin(), touches_.end(), is_pushed_out);
}

void BodyContacts::begin(const std::vector<MovingBody>& bodies, const std::vector<int>& member_of, double part) {
  bodies_ = &bodies;
  member_of_ = &member_of;
  part_ = part;
  loads_.assign(bodies.size(), Vector6::Zero());
  for (Touch& touch : touches_)
    touch.arm = touch.start_arm = touch.position - bodies[member_of[touch.body]].stepper.start_center();
}

Vector3 BodyContacts::follow(const Vector3& displacement, const Vector3& on_centre_line, Touch& touch) const {
  const RigidBodyStepper& body = (*bodies_)[member_of(touch)].stepper;
  // Of the cable's point, where forces are taken: both have the same line of action.
  touch.start_arm = touch.position - body.start_center();
  touch.arm = touch.start_arm + part_ * (on_centre_line - body.displacement());
  return displacement - displacement_of(touch);
}

/// Of the point of the body that touches, as if it stayed there: what is round may roll.
Vector3 BodyContacts::displacement_of(const Touch& touch) const {
  const RigidBodyStepper& body = (*bodies_)[member_of(touch)].stepper;
  return body.displacement() + body.turn().cross(touch.arm) + touch.turning.dot(body.turn()) * touch.point.along;
}

bool BodyContacts::press() {
  for (Vector6& load : loads_) load.setZero();
  bool changed = false;
  for (Touch& touch : touches_) {
    changed = evaluate_touch(displacement_of(touch), touch) || changed;
    if (touch.mode != Touch::Mode::open) load_on(touch, touch.force);
  }
  return changed;
}

void BodyContacts::load_on(const Touch& touch, const Vector3& force) {
  loads_[member_of(touch)] += load_on_body(touch) * force;
}

void BodyContacts::follow_obstacles() {
  for (Touch& touch : touches_)
    if (touch.mode != Touch::Mode::open) follow_correction(displacement_of(touch), touch);
}

void BodyContacts::add_loads(BodyEquations& equations) const {
  for (std::size_t m = 0; m < loads_.size(); ++m) equations.load(static_cast<int>(m)) += loads_[m];
}

void BodyContacts::add_stiffness(BodyEquations& equations) const {
  for (const Touch& touch : touches_) {
    if (touch.mode == Touch::Mode::open) continue;
    const int member = member_of(touch);
    equations.block(member, member) += load_on_body(touch) * full_slope(touch) * motion_on_body(touch);
  }
}

}  // namespace verlet_cable

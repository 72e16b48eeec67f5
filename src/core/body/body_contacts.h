#pragma once

#include <vector>

#include "body/body_equations.h"
#include "body/moving_body.h"
#include "contact/law.h"

namespace verlet_cable {

/// How a body moves where a touch acts, of a displacement and a rotation of it; and what a force on the body there does to it.
Matrix36 motion_on_body(const Touch& touch);
inline Matrix63 load_on_body(const Touch& touch) {
  return motion_on_body(touch).transpose();
}

/// What contacts do to bodies, over a substep: with obstacles, and with cables, whose side a ContactSolver has.
class BodyContacts {
 public:
  std::vector<Touch>& touches() { return touches_; }  ///< with obstacles
  const std::vector<Touch>& touches() const { return touches_; }

  /// Whether anything is pressed by an obstacle that it is inside of.
  bool is_stuck() const;

  /// `member_of`: of a body, by its index.
  void begin(const std::vector<MovingBody>& bodies, const std::vector<int>& member_of, double part);
  /// Sets where a contact with a cable acts, whose point is displaced so [m], and that of its centre line; its displacement
  /// relative to the body.
  Vector3 follow(const Vector3& displacement, const Vector3& on_centre_line, Touch& touch) const;
  /// Forgets the loads of the iterate before, and evaluates contacts with obstacles. True if one has changed its way to touch.
  bool press();
  /// Of a contact with a cable.
  void add_load(const Touch& touch) { load_on(touch, -touch.force); }
  /// After the last correction.
  void follow_obstacles();

  void add_loads(BodyEquations& equations) const;
  /// Of contacts with obstacles.
  void add_stiffness(BodyEquations& equations) const;

 private:
  int member_of(const Touch& touch) const { return (*member_of_)[touch.body]; }
  void load_on(const Touch& touch, const Vector3& force);
  Vector3 displacement_of(const Touch& touch) const;

  std::vector<Touch> touches_;
  const std::vector<MovingBody>* bodies_ = nullptr;
  const std::vector<int>* member_of_ = nullptr;
  double part_ = 1;
  std::vector<Vector6> loads_;  ///< by member
};

}  // namespace verlet_cable

#pragma once

#include <algorithm>

#include "contact/law.h"

namespace verlet_cable {

/// How far from a surface contact may matter in a substep.
class ContactReach {
 public:
  /// `still`: nothing moves but towards equilibrium, by less than a radius at a time. `time_step` [s]: the world's; h [s]: the
  /// substep's.
  ContactReach(bool still, double time_step, double h)
      : still_(still), time_step_(time_step), time_(still ? 0 : contact_time(time_step)), h_(h) {}

  double time_step() const { return time_step_; }
  double time() const { return time_; }  ///< [s] in which contacts come to rest
  double h() const { return h_; }
  /// [m] At a velocity of approach [m/s], of a cable of that radius [m].
  double at(double speed, double radius) const {
    if (still_) return (1 + spare) * radius;
    return std::min((h_ + time_) * speed, radius + h_ * speed) + spare * radius;
  }
  /// Whether a gap [m] may close, at a `velocity` [m/s] relative to what is touched.
  bool closes(double gap, const Vector3& normal, const Vector3& velocity, double radius) const {
    return gap < at(std::max(0.0, -normal.dot(velocity)), radius);
  }

 private:
  /// Contacts are looked for this far beyond where they are expected, in radii: velocities change during a substep.
  static constexpr double spare = 0.1;

  bool still_ = false;
  double time_step_ = 0, time_ = 0, h_ = 0;
};

}  // namespace verlet_cable

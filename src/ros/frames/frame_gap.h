#pragma once

#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// What lies between a frame that came back elsewhere and where it is followed, in the fixed frame's axes: closed at a steady
/// rate, on top of the frame's own motion.
struct FrameGap {
  /// At which it closes, the way no faster than the scene's max_frame_speed.
  static constexpr double speed = 1;       ///< [m/s]
  static constexpr double turn_speed = 1;  ///< [rad/s]

  Vector3 way = Vector3::Zero();             ///< [m] from the frame to where it is followed
  Quaternion turn = Quaternion::Identity();  ///< likewise, of the orientation

  static FrameGap between(const Pose& frame, const Pose& followed);

  bool is_closed() const { return way.isZero(0) && turn.vec().isZero(0); }
  double distance() const { return way.norm(); }                 ///< [m]
  double angle() const { return rotation_vector(turn).norm(); }  ///< [rad]

  void close_by(double distance, double angle);  ///< [m] and [rad]
  Pose followed(const Pose& frame) const;        ///< where a frame is followed
  Pose frame(const Pose& followed) const;        ///< the inverse
};

}  // namespace verlet_cable

#pragma once

#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// What lies between a frame that came back elsewhere and where it is followed, in the fixed frame's axes: closed at a steady
/// rate, on top of the frame's own motion.
struct FrameGap {
  /// At which it closes, the way no faster than the scene's max_frame_speed.
  static constexpr double speed = 1;       ///< [m/s]
  static constexpr double turn_speed = 1;  ///< [rad/s]
  /// [m/s] A frame that goes back faster to what it holds had come back at a pose that was wrong.
  static constexpr double fastest_motion = 10;

  Vector3 way = Vector3::Zero();             ///< [m] from the frame to where it is followed
  Quaternion turn = Quaternion::Identity();  ///< likewise, of the orientation
  bool recoils = false;                      ///< the frame goes back from a pose that was wrong

  static FrameGap between(const Pose& frame, const Pose& followed);

  bool is_closed() const { return !recoils && way.isZero(0) && turn.vec().isZero(0); }
  double distance() const { return way.norm(); }                 ///< [m]
  double angle() const { return rotation_vector(turn).norm(); }  ///< [rad]

  /// The frame moves, within `time` [s], and what it holds with it. Where it goes back to that faster than it can move, and until
  /// it has stopped, only the way between them changes.
  void move(const Pose& from, const Pose& to, double time);
  void close_by(double distance, double angle);  ///< [m] and [rad]
  Pose followed(const Pose& frame) const;        ///< where a frame is followed
  Pose frame(const Pose& followed) const;        ///< the inverse
};

}  // namespace verlet_cable

#pragma once

#include <map>
#include <string>
#include <vector>

#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// The pose of a frame over time, interpolated between given poses (rows): positions by a cubic Hermite spline with limited
/// tangents, orientations by slerp; constant before the first row and after the last. Equal rows give a frame at rest, and rows
/// that advance along a line never make the frame turn back. scripts/play_motion.py does the same.
class FrameTrack {
 public:
  /// Adds a pose [m] at a time [s] above that of the last one.
  void add(double time, const Pose& pose);
  /// A frame that goes faster than `jump_speed` [m/s] from one row to the next, and not before and after, has jumped: until that
  /// row it stays where it was.
  void find_jumps(double jump_speed);

  /// The pose at a time [s]; at least one pose must have been added.
  Pose at(double time) const;
  /// Velocity just after a time [s]; zero before the first row, and from the last row on.
  FrameVelocity velocity_from(double time) const;

  bool empty() const { return times_.empty(); }
  double last_time() const { return times_.back(); }           ///< [s]
  const std::vector<double>& times() const { return times_; }  ///< [s]
  const std::vector<Pose>& poses() const { return poses_; }    ///< one a time

 private:
  std::size_t row_after(double time) const;
  Vector3 tangent(std::size_t row, double duration) const;

  std::vector<double> times_;  ///< [s] ascending
  std::vector<Pose> poses_;    ///< one a time
  std::vector<char> jumps_;    ///< likewise: whether the frame jumps there
};

/// Tracks by frame name, in the fixed frame.
using Motion = std::map<std::string, FrameTrack>;

/// Reads a CSV file with the header `t,frame,x,y,z,qx,qy,qz,qw` [s, m]: frames in any order, times ascending per frame,
/// quaternions of any length but 0, at most ten million rows. Throws SceneError with all errors (at most 100), each with its
/// line.
Motion read_motion_file(const std::string& path);

}  // namespace verlet_cable

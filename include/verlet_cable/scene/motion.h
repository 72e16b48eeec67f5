#pragma once

#include <map>
#include <string>
#include <vector>

#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// The pose of a frame over time, through given poses: positions follow a cubic Hermite spline (Catmull-Rom), orientations slerp;
/// held before the first pose and after the last.
class FrameTrack {
 public:
  /// Adds a pose [m] at a time [s] above that of the last one.
  void add(double time, const Pose& pose);

  /// At least one pose was added.
  Pose at(double time) const;

  bool empty() const { return times_.empty(); }
  double last_time() const { return times_.back(); }  ///< [s]

 private:
  Vector3 velocity(std::size_t row) const;

  std::vector<double> times_;  ///< [s] ascending
  std::vector<Pose> poses_;    ///< one a time
};

/// Tracks by frame name, in the fixed frame.
using Motion = std::map<std::string, FrameTrack>;

/// Reads a CSV file with the header `t,frame,x,y,z,qx,qy,qz,qw` [s, m]: frames in any order, times ascending per frame,
/// quaternions of any length but 0, at most ten million rows. Throws SceneError with all errors (at most 100), each with its
/// line.
Motion read_motion_file(const std::string& path);

}  // namespace verlet_cable

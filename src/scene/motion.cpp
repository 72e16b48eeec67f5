#include "verlet_cable/scene/motion.h"

#include <algorithm>

namespace verlet_cable {

void FrameTrack::add(double time, const Pose& pose) {
  times_.push_back(time);
  poses_.push_back(pose);
}

Pose FrameTrack::at(double time) const {
  if (time <= times_.front()) return poses_.front();
  if (time >= times_.back()) return poses_.back();
  const auto next = static_cast<std::size_t>(std::upper_bound(times_.begin(), times_.end(), time) - times_.begin());
  const Pose& from = poses_[next - 1];
  const Pose& to = poses_[next];
  const double duration = times_[next] - times_[next - 1];
  const double u = (time - times_[next - 1]) / duration;
  const Vector3 position = (1 + 2 * u) * (1 - u) * (1 - u) * from.position + u * u * (3 - 2 * u) * to.position +
                           duration * u * (1 - u) * ((1 - u) * velocity(next - 1) - u * velocity(next));
  return {position, from.orientation.slerp(u, to.orientation).normalized()};
}

// Tangents of the Catmull-Rom spline for unequal intervals (Barry and Goldman 1988); one-sided at the ends.
Vector3 FrameTrack::velocity(std::size_t row) const {
  const auto slope = [this](std::size_t i) -> Vector3 {
    return (poses_[i + 1].position - poses_[i].position) / (times_[i + 1] - times_[i]);
  };
  if (row == 0) return slope(0);
  if (row + 1 == times_.size()) return slope(row - 1);
  const double before = times_[row] - times_[row - 1];
  const double after = times_[row + 1] - times_[row];
  return (after * slope(row - 1) + before * slope(row)) / (before + after);
}

}  // namespace verlet_cable

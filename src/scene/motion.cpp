#include "verlet_cable/scene/motion.h"

#include <algorithm>

namespace verlet_cable {

void FrameTrack::add(double time, const Pose& pose) {
  times_.push_back(time);
  poses_.push_back(pose);
}

/// The first row that is later than a time between the first and the last.
std::size_t FrameTrack::row_after(double time) const {
  return static_cast<std::size_t>(std::upper_bound(times_.begin(), times_.end(), time) - times_.begin());
}

Pose FrameTrack::at(double time) const {
  if (time <= times_.front()) return poses_.front();
  if (time >= times_.back()) return poses_.back();
  const std::size_t next = row_after(time);
  const Pose& from = poses_[next - 1];
  const Pose& to = poses_[next];
  const double duration = times_[next] - times_[next - 1];
  const double u = (time - times_[next - 1]) / duration;
  // The way from the first row is weighted, not the two places: what stands does so exactly, however far it is from the origin.
  const Vector3 way = u * u * (3 - 2 * u) * (to.position - from.position) +
                      u * (1 - u) * ((1 - u) * tangent(next - 1, duration) - u * tangent(next, duration));
  return {from.position + way, from.orientation.slerp(u, to.orientation).normalized()};
}

FrameVelocity FrameTrack::velocity_from(double time) const {
  if (time < times_.front() || time >= times_.back()) return {};
  const std::size_t next = row_after(time);
  const Pose& from = poses_[next - 1];
  const Pose& to = poses_[next];
  const double duration = times_[next] - times_[next - 1];
  const double u = (time - times_[next - 1]) / duration;
  const Vector3 way = 6 * u * (1 - u) * (to.position - from.position) +
                      (1 - u) * (1 - 3 * u) * tangent(next - 1, duration) + u * (3 * u - 2) * tangent(next, duration);
  return {way / duration, rotation_vector(to.orientation * from.orientation.conjugate()) / duration};
}

/// The spline's tangent at a row times a duration [m], that of the interval before or after it. At an inner row it is the mean
/// velocity between the neighbouring rows, not longer than three times the slower of those on both sides (the condition of Fritsch
/// and Carlson 1980, with which a cubic does not turn back).
Vector3 FrameTrack::tangent(std::size_t row, double duration) const {
  const auto velocity = [&](std::size_t from, std::size_t to) -> Vector3 {
    const Vector3 way = poses_[to].position - poses_[from].position;
    return way.isZero(0) ? way : Vector3(way / ((times_[to] - times_[from]) / duration));
  };
  if (row == 0) return velocity(0, 1);
  if (row + 1 == times_.size()) return velocity(row - 1, row);
  const Vector3 mean = velocity(row - 1, row + 1);
  const double longest = 3 * std::min(velocity(row - 1, row).stableNorm(), velocity(row, row + 1).stableNorm());
  const double length = mean.stableNorm();
  return length > longest ? Vector3(longest / length * mean) : mean;
}

}  // namespace verlet_cable

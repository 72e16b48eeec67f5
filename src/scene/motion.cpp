#include "verlet_cable/scene/motion.h"

#include <algorithm>

#include "spline.h"

namespace verlet_cable {

void FrameTrack::add(double time, const Pose& pose) {
  times_.push_back(time);
  poses_.push_back(pose);
  jumps_.push_back(false);
}

void FrameTrack::find_jumps(double jump_speed) {
  const auto is_fast = [&](std::size_t next) {
    return next > 0 && next < times_.size() &&
           (poses_[next].position - poses_[next - 1].position).norm() > jump_speed * (times_[next] - times_[next - 1]);
  };
  for (std::size_t next = 1; next < times_.size(); ++next)
    jumps_[next] = is_fast(next) && !is_fast(next - 1) && !is_fast(next + 1);
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
  if (jumps_[next]) return from;
  const Pose& to = poses_[next];
  const double duration = times_[next] - times_[next - 1];
  const double u = (time - times_[next - 1]) / duration;
  // The way from the first row is weighted, not the two places: what stands does so exactly, however far it is from the origin.
  const Vector3 way = spline_way(u, to.position - from.position, tangent(next - 1, duration), tangent(next, duration));
  return {from.position + way, from.orientation.slerp(u, to.orientation).normalized()};
}

FrameVelocity FrameTrack::velocity_from(double time) const {
  if (time < times_.front() || time >= times_.back()) return {};
  const std::size_t next = row_after(time);
  if (jumps_[next]) return {};
  const Pose& from = poses_[next - 1];
  const Pose& to = poses_[next];
  const double duration = times_[next] - times_[next - 1];
  const double u = (time - times_[next - 1]) / duration;
  const Vector3 way = 6 * u * (1 - u) * (to.position - from.position) + (1 - u) * (1 - 3 * u) * tangent(next - 1, duration) +
                      u * (3 * u - 2) * tangent(next, duration);
  return {way / duration, rotation_vector(to.orientation * from.orientation.conjugate()) / duration};
}

/// The spline's tangent at a row times a duration [m], that of the interval before or after it. At an inner row it is the mean
/// velocity between the neighbouring rows, not longer than three times the slower of those on both sides (the condition of
/// Fritsch and Carlson 1980, with which a cubic does not turn back). Beside a jump it is that of the other side.
Vector3 FrameTrack::tangent(std::size_t row, double duration) const {
  const auto velocity = [&](std::size_t from, std::size_t to) -> Vector3 {
    const Vector3 way = poses_[to].position - poses_[from].position;
    return way.isZero(0) ? way : Vector3(way / ((times_[to] - times_[from]) / duration));
  };
  if (row + 1 == times_.size()) return velocity(row - 1, row);
  if (row == 0 || jumps_[row]) return velocity(row, row + 1);
  if (jumps_[row + 1]) return velocity(row - 1, row);
  return shortened(velocity(row - 1, row + 1),
                   std::min(velocity(row - 1, row).stableNorm(), velocity(row, row + 1).stableNorm()));
}

}  // namespace verlet_cable

#include "frames/pose_track.h"

#include <algorithm>
#include <cmath>

#include "scene/spline.h"

namespace verlet_cable {
namespace {

/// As long [ns] straight lines along the spline may be: not what usual rates of tf are multiples of, so that the rounding of
/// stamps does not decide on their number.
constexpr Nanoseconds longest_line = 7'000'000;

Quaternion turned_by(const Vector3& turn, const Quaternion& orientation) {
  const double angle = turn.norm();
  if (angle == 0) return orientation;
  return (Quaternion(Eigen::AngleAxisd(angle, turn / angle)) * orientation).normalized();
}

/// The velocity at the end of an interval whose mean velocity was `mean`, `before` that of the interval before it.
Vector3 carried_on(const Vector3& before, const Vector3& mean) {
  return shortened(mean + 0.5 * (mean - before), mean.norm());
}

}  // namespace

std::vector<PoseSample> PoseTrack::add(const PoseSample& sample, const std::vector<Vector3>& carried) {
  if (!last_) {
    begin_anew(sample);
    return {sample};
  }
  if (sample.stamp <= (held_ ? held_ : last_)->stamp) return {sample};
  std::vector<PoseSample> played;
  if (held_) {
    const PoseSample held = *held_;
    held_.reset();
    if (is_fast(held, sample, carried)) {
      was_fast_ = true;
      follow(held, played);
    } else {
      played.push_back({held.stamp - 1, last_->pose});
      played.push_back(held);
      begin_anew(held);
    }
  }
  const bool fast = is_fast(*last_, sample, carried);
  if (fast && !was_fast_ && sample.stamp - last_->stamp <= longest_gap_) {
    held_ = sample;
    return played;
  }
  was_fast_ = fast;
  follow(sample, played);
  return played;
}

bool PoseTrack::is_fast(const PoseSample& from, const PoseSample& to, const std::vector<Vector3>& carried) const {
  const double longest_way = jump_speed_ * seconds(to.stamp - from.stamp);
  const auto goes_further = [&](const Vector3& point) {
    return (to.pose.position + to.pose.orientation * point - from.pose.position - from.pose.orientation * point).norm() >
           longest_way;
  };
  return goes_further(Vector3::Zero()) || std::any_of(carried.begin(), carried.end(), goes_further);
}

/// Plays the way to a sample.
void PoseTrack::follow(const PoseSample& sample, std::vector<PoseSample>& played) {
  const PoseSample& from = *last_;
  const Nanoseconds interval = sample.stamp - from.stamp;
  const double duration = seconds(interval);
  const Vector3 way = sample.pose.position - from.pose.position;
  const Vector3 turn = rotation_vector(sample.pose.orientation * from.pose.orientation.conjugate());
  if (interval > longest_gap_) {
    begin_anew(sample);
    played.push_back(sample);
    return;
  }
  const Velocity mean{way / duration, turn / duration};
  const Velocity before = mean_.value_or(mean), arrival = mean_ ? arrival_ : mean;
  const Velocity start{shortened(arrival.linear, mean.linear.norm()), shortened(arrival.angular, mean.angular.norm())};
  const Velocity end{carried_on(before.linear, mean.linear), carried_on(before.angular, mean.angular)};
  const Nanoseconds lines = (interval + longest_line - 1) / longest_line;
  for (Nanoseconds i = 1; i < lines; ++i) {
    const Nanoseconds since = interval * i / lines;
    const double u = static_cast<double>(since) / static_cast<double>(interval);
    played.push_back({from.stamp + since,
                      {from.pose.position + spline_way(u, way, duration * start.linear, duration * end.linear),
                       turned_by(spline_way(u, turn, duration * start.angular, duration * end.angular), from.pose.orientation)},
                      true});
  }
  played.push_back(sample);
  mean_ = mean;
  arrival_ = end;
  last_ = sample;
}

/// The frame goes on from a sample without a way to it.
void PoseTrack::begin_anew(const PoseSample& sample) {
  last_ = sample;
  held_.reset();
  was_fast_ = false;
  mean_.reset();
}

}  // namespace verlet_cable

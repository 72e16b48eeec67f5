#pragma once

#include <optional>
#include <vector>

#include "time/time_grid.h"
#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// Where a frame is in its parent at a time.
struct PoseSample {
  Nanoseconds stamp = 0;
  Pose pose;
  bool is_between = false;  ///< a point of the spline between samples
};

/// The samples of one transform of tf, made into what is played: straight lines between poses.
///
/// A frame that goes faster than `jump_speed` from one sample to the next, and was slower before and is slower after, has jumped:
/// it stays where it was until that sample, and is there then. Two fast intervals in a row are motion. What shows the first fast
/// interval is therefore held back until the next sample tells which it is; until then the frame is known up to the sample
/// before. A frame goes as fast as the fastest of what it carries: a base that turns takes a hand along.
///
/// Between samples that are far apart the frame follows a spline, so that its velocity does not jump from sample to sample: it
/// leaves a sample with the velocity with which it came there, that of the two intervals before carried on. No later sample is
/// needed for it. It depends on the samples alone, not on when they arrive.
class PoseTrack {
 public:
  /// [m/s]; `longest_gap`: between samples that are further apart nothing is known.
  PoseTrack(double jump_speed, Nanoseconds longest_gap) : jump_speed_(jump_speed), longest_gap_(longest_gap) {}

  /// What is to be played now that a sample has come, ascending; empty where it is held back. A sample that is no later than
  /// those before is played as it is. `carried`: [m] points in the frame that are to be followed, besides its origin.
  std::vector<PoseSample> add(const PoseSample& sample, const std::vector<Vector3>& carried = {});

 private:
  /// Of the frame at a sample, a way and a turn [1/s].
  struct Velocity {
    Vector3 linear = Vector3::Zero();
    Vector3 angular = Vector3::Zero();
  };

  bool is_fast(const PoseSample& from, const PoseSample& to, const std::vector<Vector3>& carried) const;
  void follow(const PoseSample& sample, std::vector<PoseSample>& played);
  void begin_anew(const PoseSample& sample);

  double jump_speed_;
  Nanoseconds longest_gap_;
  std::optional<PoseSample> last_;  ///< that is played
  std::optional<PoseSample> held_;  ///< after it, a jump or the beginning of a fast motion
  bool was_fast_ = false;           ///< up to the last one
  std::optional<Velocity> mean_;    ///< over the interval up to the last one; none at the beginning: the next way is straight
  Velocity arrival_;                ///< with which the frame came to the last one
};

}  // namespace verlet_cable

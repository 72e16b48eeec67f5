#pragma once

#include <tf2/buffer_core.h>

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "frames/pose_track.h"
#include "frames/stored_transforms.h"
#include "frames/tf_listener.h"
#include "time/time_grid.h"
#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// A frame's name as tf2 has it: older programs send it with a leading slash.
std::string without_slash(const std::string& frame);

/// Why a transform cannot be used; empty if it can. Refused are values that are not finite, quaternions that are not of length
/// one, missing, endless or equal frame names, and a transform over time without a stamp, or with one that is later than
/// FrameBuffer::latest. `now` is 0 where there is no time.
std::string transform_problem(const ReceivedTransform& received, Nanoseconds now = 0);

/// The tree of frames over the last 60 s, seen from the fixed frame. The one place that talks to tf2 and catches what it throws.
class FrameBuffer {
 public:
  static constexpr Nanoseconds memory = 60'000'000'000;  ///< how long transforms are kept
  /// That a stamp may be ahead of ROS time. Localisation dates its transforms ahead by a second or so, and with a clock that is
  /// published, tf may come before the clock does. What is further ahead is a mistake, and would be where the frame is newest.
  static constexpr Nanoseconds most_ahead = 2'000'000'000;
  /// That are kept at once, of all frames: 1.3 GB. A hundred frames at 1 kHz have as many.
  static constexpr std::size_t most_stored = 6'000'000;

  explicit FrameBuffer(std::string fixed_frame, std::size_t most_stored = FrameBuffer::most_stored);

  /// Which frames have jumped, see PoseTrack; from now on, for transforms that come then.
  void follow(double jump_speed, Nanoseconds longest_gap);
  /// The stamps from which on a frame is known now that the transform has come, ascending: its own, and that of one which was
  /// held back, see PoseTrack; none if it is held back or refused. A static one has stamp 0. What is wrong with it is logged now
  /// and then, and counted. `carried`: [m] points in the child frame that move with it.
  std::vector<Nanoseconds> insert(const ReceivedTransform& received, Nanoseconds now = 0,
                                  const std::vector<Vector3>& carried = {});
  /// Whether the names are short enough to be kept.
  static bool has_room_for_names(const geometry_msgs::TransformStamped& transform);
  /// The latest stamp that is taken at ROS time `now`; where there is no time, the latest that can be stored.
  static Nanoseconds latest(Nanoseconds now);
  /// Whether there are transforms of later than `time`.
  bool reaches_beyond(Nanoseconds time) const;
  void see_from(const std::string& fixed_frame);
  /// Forgets everything but static transforms.
  void clear();

  /// Of a frame in the fixed frame at a time; none where the tree does not know it.
  std::optional<Pose> pose(const std::string& frame, Nanoseconds time) const;
  /// [m] A frame's origin in another frame, as last known; none where the tree does not connect them.
  std::optional<Vector3> position_in(const std::string& other, const std::string& frame) const;
  /// The newest time at which the frame is known; 0 for one that does not depend on time; none where it is not connected.
  std::optional<Nanoseconds> newest(const std::string& frame) const;

  /// The child frames of the transforms between a frame and the fixed frame, and of those above both: `newest` changes with
  /// these only.
  std::set<std::string> transforms_of(const std::string& frame) const;
  /// The root of the tree that a frame is in, where that is another one than the fixed frame's; none where the two are connected,
  /// and for a frame that tf has not had.
  std::optional<std::string> other_root(const std::string& frame) const;
  int tree_version() const { return tree_version_; }  ///< another number: `transforms_of` may be others

  const std::map<std::string, std::string>& refused() const {
    return refused_;
  }  ///< by child frame, whose last transform was bad; of so many that people can read them
  /// The nodes that send a frame which more than one has sent in the last second, by child frame: they may disagree.
  std::map<std::string, std::vector<std::string>> disputed() const;
  /// Child frames that came on /tf and on /tf_static: tf2 cannot follow them well.
  const std::set<std::string>& mixed() const { return mixed_; }
  int refused_count() const { return refused_count_; }  ///< since the start

 private:
  bool accept(const ReceivedTransform& received, const std::string& child, Nanoseconds now);
  bool play(const geometry_msgs::TransformStamped& transform, const std::string& child);
  void refuse(const std::string& child, const std::string& problem);
  bool know(const std::string& frame);
  void note_kind(const std::string& child, bool is_static);
  bool note_parent(const std::string& child, const std::string& parent);
  void note_source(const std::string& child, const std::string& source);
  std::string root_of(const std::string& frame) const;

  std::string fixed_frame_;
  tf2::BufferCore buffer_;
  StoredTransforms stored_;                  ///< in it, but for static ones
  double jump_speed_ = infinity;             ///< [m/s]
  Nanoseconds longest_gap_ = memory;         ///< that a frame may be silent
  std::map<std::string, PoseTrack> tracks_;  ///< by child frame, of dynamic transforms
  std::set<std::string> frames_;             ///< names that tf2 has, which it never forgets
  std::map<std::string, bool> static_;       ///< by child frame: whether it came as a static one first
  std::set<std::string> mixed_;
  std::map<std::string, Nanoseconds> newest_;                            ///< by child frame, dynamic transforms
  std::map<std::string, std::string> parents_;                           ///< by child frame, as in its newest transform
  std::map<std::string, std::map<std::string, ros::WallTime>> sources_;  ///< by child frame and node: when it last came
  std::map<std::string, std::string> refused_;
  std::map<std::string, ros::WallTime> logged_;  ///< by child frame, when a refusal was last logged
  int refused_count_ = 0;
  int tree_version_ = 0;
};

}  // namespace verlet_cable

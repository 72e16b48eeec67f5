#pragma once

#include <ros/ros.h>

#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "frames/frame_buffer.h"
#include "frames/frame_gap.h"
#include "frames/frame_history.h"
#include "frames/tf_listener.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

enum class FrameStatus {
  never_seen,
  ok,
  late,     ///< tf has nothing for the simulated time yet
  lost,     ///< tf has had nothing for longer than `tf_timeout`
  computed  ///< a body's: the world says where it is, tf is not asked
};

struct FrameChange {
  enum class Kind { seen, lost, back, too_fast };
  Kind kind;
  int frame;            ///< id
  double distance = 0;  ///< [m] back: from where the frame was held
  double angle = 0;     ///< [rad] likewise
};

struct FrameReport {
  std::string name;
  FrameStatus status = FrameStatus::never_seen;
  bool is_static = false;
  Nanoseconds newest = 0;  ///< stamp of the newest pose, 0 if static or never seen
  bool too_fast = false;   ///< is being followed at `max_frame_speed`
};

/// A frame as a snapshot keeps it.
struct SavedFrame {
  std::string name;
  FrameInput input;
  FrameGap gap;
  FrameStatus status = FrameStatus::never_seen;
};

/// The poses of frames at the times of steps, from tf. A frame's id is its index in World::frames(). Those of bodies have ids,
/// too, but no poses: nothing waits for them, and they are never lost.
class TfInputs {
 public:
  TfInputs(const ros::NodeHandle& node, const SceneDesc& scene);

  /// Follows the frames of another scene from `time` on.
  void follow_scene(const SceneDesc& scene, Nanoseconds time);

  /// Takes in what has come on tf; `now`: ROS time, 0 if there is none yet.
  void receive(Nanoseconds now);
  /// After ROS time went back to `now`: what tf said before is void. With `forget`, frames count as never seen, too.
  void restart(Nanoseconds now, bool forget);
  /// Drops the frames that pins and obstacles added.
  void drop_pinned_frames();
  /// Drops them, and puts the others where they are at `time`.
  void reset(Nanoseconds time);
  /// Follows another frame from now on, or from when tf shows it; its id.
  int add(const std::string& frame, Nanoseconds time);

  std::vector<SavedFrame> save() const;  ///< by frame id
  /// Follows the frames that were saved, from where they are now on; frames that tf does not know are where they were saved.
  void restore(const std::vector<SavedFrame>& saved, Nanoseconds time);
  /// The same from where they were saved, `time` being the time of that.
  void rewind(const std::vector<SavedFrame>& saved, Nanoseconds time);

  bool all_seen() const;
  Nanoseconds first_common_time() const;  ///< from which on all frames that were seen are known; 0 if they are static

  /// The frames at `time`, for `inputs` and `changes`. False, and nothing changed, if a needed frame (by id) is late and has to
  /// be waited for: it is lost when its newest pose is more than `tf_timeout` older than `target`, the time at which the
  /// simulation should be. No frame is followed faster than `max_frame_speed` in the `elapsed` time since the last sample. A
  /// frame that was lost and comes back elsewhere is approached as FrameGap says, or at once where its loss released what it
  /// held.
  bool sample(Nanoseconds time, Nanoseconds elapsed, Nanoseconds target, const std::vector<bool>& needed);
  /// The same, with the newest pose of a frame that is late.
  void sample_without_waiting(Nanoseconds time, Nanoseconds elapsed);
  /// The same, without a limit of speed.
  void sample_at_once(Nanoseconds time);

  const BoundaryInputs& inputs() const { return inputs_; }
  const std::vector<FrameChange>& changes() const { return changes_; }  ///< that the last sample found

  /// From when on the needed frames that were lost at `time` are known again: none while one is still lost, 0 if nothing is lost.
  std::optional<Nanoseconds> back_after(Nanoseconds time, const std::vector<bool>& needed) const;

  /// Any frame of tf: at `time`, or where it is latest if tf does not know that.
  std::optional<Pose> find(const std::string& frame, Nanoseconds time) const;

  std::vector<FrameReport> report() const;
  const FrameBuffer& buffer() const { return buffer_; }

 private:
  struct Track {
    Track(std::string frame, const FrameInput& at, Nanoseconds longest_gap)
        : name(std::move(frame)), initial(at), history(longest_gap) {}
    std::string name;
    FrameInput initial;  ///< what the scene says
    FrameHistory history;
    FrameStatus status = FrameStatus::never_seen;
    bool too_fast = false;
    FrameGap gap;
    Nanoseconds last_known = 0;  ///< time of the last sample for which tf had a pose

    bool is_body() const { return status == FrameStatus::computed; }
  };

  void insert(const ReceivedTransform& received, Nanoseconds now);
  void unsee_frames();
  void replay_recent(Nanoseconds now, Nanoseconds latest);
  void find_followers();
  const std::vector<int>& followers_of(const std::string& child);
  std::vector<Vector3> carried_by(const std::string& child);
  void update_history(Track& track) const;
  void fill_history(Track& track, Nanoseconds stamp) const;
  const Track* find_track(const std::string& frame) const;
  Track track_from(const std::string& frame, const FrameInput& at, Nanoseconds time) const;
  Track computed_track(const std::string& frame) const;
  bool must_wait(Track& track, Nanoseconds time, Nanoseconds target) const;
  void sample_frames(Nanoseconds time, Nanoseconds target, Nanoseconds elapsed);
  void sample_frame(int frame, Nanoseconds time, Nanoseconds target, Nanoseconds elapsed);
  void come_back(int frame, const Pose& pose);
  void place(int frame, const Pose& pose);
  void follow(int frame, const Pose& pose, Nanoseconds stamp, Nanoseconds time, Nanoseconds elapsed);
  void move_gap(Track& track, const Pose& from, const Pose& to, Nanoseconds begin, Nanoseconds end) const;
  void change(FrameChange::Kind kind, int frame) { changes_.push_back({kind, frame}); }

  TfListener listener_;
  FrameBuffer buffer_;
  std::deque<ReceivedTransform> received_;                          ///< not yet in the buffer
  std::deque<std::pair<ros::WallTime, ReceivedTransform>> recent_;  ///< with the time of arrival
  bool has_time_ = false;                                           ///< `receive` has been told a ROS time
  Nanoseconds timeout_ = 0;
  double max_frame_speed_ = infinity;
  bool approaches_ = true;                             ///< frames that come back
  int scene_frames_ = 0;                               ///< those of bodies included
  std::vector<Track> tracks_;                          ///< by frame id; the first is the fixed frame
  std::map<std::string, std::vector<int>> followers_;  ///< by child frame of a transform: the frame ids it moves
  std::optional<int> followers_version_;               ///< of the tree, for which they hold; none: tracks have changed
  BoundaryInputs inputs_;                              ///< by frame id
  std::vector<FrameChange> changes_;
};

}  // namespace verlet_cable

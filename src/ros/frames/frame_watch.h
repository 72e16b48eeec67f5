#pragma once

#include <ros/time.h>

#include <map>
#include <set>
#include <string>
#include <vector>

#include "frames/tf_inputs.h"
#include "publish/event_publisher.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// What happens when frames are lost and come back: events, log, and the scene's `on_lost_frame`.
class FrameWatch {
 public:
  FrameWatch(const SceneDesc& scene, const EventPublisher& events);
  /// Watches the frames of another scene from now on.
  void watch(const SceneDesc& scene);

  /// Acts on what a sample of the frames found; `stamp` is the simulated time. Releases attachments if the scene wants that. True
  /// if the simulation has to wait for a frame.
  bool react(const std::vector<FrameChange>& changes, Nanoseconds stamp, World& world);
  /// Reports frames whose jumps the last step found to be over, each once a second at most.
  void report_jumps(Nanoseconds stamp, const World& world);
  /// Warns of frames whose poses the world ignores, each every 10 s of wall time at most.
  void warn_of_ignored(const World& world, const BoundaryInputs& inputs);
  /// Time is skipped at the world's `time`: what frames do over it is no jump of theirs.
  void skip(double time) { skipped_ = time; }
  /// Forgets which frames were lost, from an id on.
  void forget_from(int frame) { lost_.erase(lost_.lower_bound(frame), lost_.end()); }

 private:
  void report_lost(int frame, Nanoseconds stamp, const World& world);
  void report_back(const FrameChange& change, Nanoseconds stamp, const World& world);
  void release(int frame, Nanoseconds stamp, World& world) const;

  LostFramePolicy policy_;
  double max_frame_speed_;  ///< [m/s]
  double timeout_;          ///< [s]
  const EventPublisher& events_;
  std::set<int> lost_;                            ///< ids of the frames whose loss was reported
  std::map<int, Nanoseconds> jumped_;             ///< by frame id: the stamp of the last jump that was reported
  double skipped_ = -1;                           ///< [s] the world's time when time was skipped last
  std::map<std::string, ros::WallTime> ignored_;  ///< by frame: the last warning
};

/// Whether obstacles move with a frame.
bool has_obstacles(int frame, const World& world);
/// By frame id: whether the frame holds a cable.
std::vector<bool> needed_frames(const World& world);
/// By frame id: whether a step waits for the frame while it is late, as it holds a cable or moves an obstacle.
std::vector<bool> awaited_frames(const World& world);

}  // namespace verlet_cable

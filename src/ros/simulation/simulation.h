#pragma once

#include <ros/ros.h>

#include <deque>
#include <list>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "edit_requests/checked_load.h"
#include "edit_requests/checked_pin.h"
#include "frames/frame_watch.h"
#include "frames/missing_frames.h"
#include "frames/tf_inputs.h"
#include "publish/event_publisher.h"
#include "publish/publishers.h"
#include "simulation/attachment_moves.h"
#include "simulation/cable_watch.h"
#include "simulation/simulation_report.h"
#include "simulation/world_build.h"
#include "threads/background_tasks.h"
#include "threads/owner_calls.h"
#include "time/clock_watch.h"
#include "time/overload_watch.h"
#include "time/pacer.h"
#include "time/time_grid.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// An obstacle that was added while running.
struct AddedObstacle {
  Obstacle obstacle;
  std::string frame;
};

/// What `save_state` keeps: with it a run goes on as it would have.
struct Snapshot {
  World world;
  SceneDesc scene;        ///< as it was tuned
  Nanoseconds stamp = 0;  ///< the simulated time
  std::vector<SavedFrame> frames;
  std::map<std::string, AddedObstacle> added_obstacles;
};

/// A world that runs `tf_latency` behind ROS time, follows tf, and is published. For one thread: requests are called between
/// updates.
class Simulation {
 public:
  /// An update, and a part of a request, is cut off after this, so that others do not wait.
  static const ros::WallDuration longest_slice;

  /// Throws SceneError. The scene is built when it starts, aside: until then requests are refused that need it.
  Simulation(ros::NodeHandle& private_node, const SceneDesc& scene);

  /// Does the steps that are due now, for no longer than about `longest` of wall time; to be called more often than ticks are
  /// published.
  void update(ros::WallDuration longest);

  // Requests. One that is refused changes nothing. Those with an Answer may take many updates, between which others are done.
  /// Back to the scene's initial state, with the frames where they are now. Where that takes long to build the old world goes on
  /// until the new one is there.
  void reset(const Answer& answer);
  EditResult set_paused(bool paused);
  /// Does steps while paused, and publishes the last. Resets, other scenes and the end of the pause interrupt them.
  void step(std::int64_t steps, const Answer& answer);
  /// Holds a node in a frame, which is at `frame_pose` if the world does not know it yet. No name: one is made.
  EditResult pin(const std::string& name, const CheckedPin& pin, AttachmentType type);
  EditResult unpin(const std::string& name);
  /// Sends an attachment to another pose in its frame; it gets there smoothly.
  EditResult move_attachment(const std::string& name, const Pose& offset);
  /// Removes a segment of a cable, or links of a net.
  EditResult cut(const Location& place);
  EditResult set_length(const std::string& cable, bool at_end, double length, double speed, double max_tension);
  EditResult set_tension(const std::string& cable, const edit::SetTension& change);
  EditResult join(const std::string& first, bool first_at_end, const std::string& second, bool second_at_end);
  /// A load on a place, in terms of the world.
  CheckedLoad check_load(const RequestedLoad& request, const RequestedPlace& place) const;
  /// One that was checked.
  EditResult apply_load(const edit::ApplyLoad& load);
  /// Adds an obstacle to those of the scene, or replaces one that was added; it follows `frame` from when that is known on. It
  /// stays until it is removed, whatever happens to the scene.
  EditResult set_obstacle(Obstacle obstacle, const std::string& frame);
  void remove_obstacle(const std::string& name);  ///< of those that were added
  /// Under a name, or in a file.
  EditResult save_state(const std::string& name, const std::string& file);
  /// Continues a snapshot: while paused at its time and with its frames, while running at the present ones. One of a file knows
  /// neither.
  EditResult restore_state(const std::string& name, const std::string& file);
  /// Goes on with another scene, as soon as it is built; refused if it is not sound. One that was asked for before and is not
  /// built yet then is given up.
  void load_scene(const SceneDesc& scene, const Answer& answer);
  /// Goes on with other gravity, fluid and materials; everything else of `scene` is as it is.
  void tune(const SceneDesc& scene);

  const SceneDesc& scene() const { return scene_; }
  int scene_version() const { return scene_version_; }  ///< another number, another scene or tuning
  const World& world() const { return world_; }
  const TfInputs& frames() const { return frames_; }
  /// Of an attachment in the fixed frame; of one that was sent somewhere, there.
  Pose attachment_pose(const Attachment& attachment) const;
  /// Where a frame is at the simulated time; none if neither the world nor tf knows it.
  std::optional<Pose> find_frame(const std::string& frame) const;
  /// The snapshot of that name, the present state for an empty one; none if there is no such.
  std::optional<Snapshot> snapshot(const std::string& name) const;
  const std::map<std::string, AddedObstacle>& added_obstacles() const { return added_obstacles_; }  ///< by name
  Nanoseconds now() const { return clock_.now(); }  ///< ROS time at the last update
  Nanoseconds stamp() const { return stamp_; }      ///< the simulated time, as ROS time
  bool started() const { return started_; }
  EditResult refused_before_start() const;     ///< what it waits for, as the refusal of a request
  bool busy() const { return tasks_.busy(); }  ///< aside; the end of the simulation waits for what it can cancel
  /// Statistics are those since the last call.
  SimulationReport take_report();

 private:
  Snapshot read_snapshot(const std::string& file) const;
  EditResult restore(const Snapshot& snapshot, const std::string& message);
  /// What replaces the world when it is built.
  struct Rebuild {
    WorldBuild build;
    SceneDesc scene;
    int scene_version = 0;        ///< when it began
    bool loads = false;           ///< another scene; or it is a reset
    std::vector<Answer> answers;  ///< to all that asked for it
  };
  /// The first world of a run.
  struct Start {
    WorldBuild build;
    Nanoseconds time = 0;   ///< from which it goes on
    int scene_version = 0;  ///< when it began
  };
  struct AwaitedSteps {
    std::int64_t asked = 0, done = 0;
    Answer answer;
  };

  /// What is further behind than this is not caught up.
  static Nanoseconds longest_backlog(const SceneDesc& scene);
  Nanoseconds target() const;  ///< the time at which the simulation should be
  void use_scene(const SceneDesc& scene);
  void jump_back();
  void start_if_possible();
  void prepare_start(Nanoseconds time);
  void finish_start();
  void start(Nanoseconds time);
  void sample_at_start(Nanoseconds time);
  World build(const BoundaryInputs& frames);
  void use_world(World world);
  void build_aside(const SceneDesc& scene, bool loads, const Answer& answer);
  BoundaryInputs present_frames(const SceneDesc& scene) const;
  void finish_rebuilds();
  bool finish_newest_load();
  EditResult finish(Rebuild rebuild);
  void forget(bool loads, std::list<Rebuild>::iterator end, const std::string& message);
  void forget_resets(const std::string& reason);
  EditResult start_anew(World world);
  EditResult replace_scene(const SceneDesc& scene, World world);
  void do_awaited_steps(ros::WallDuration longest);
  void interrupt_steps(const std::string& reason);
  void catch_up(ros::WallDuration longest);
  bool do_step(Nanoseconds time, std::vector<bool>& awaited);
  void continue_if_frames_are_back();
  void stand();
  bool step_world(Nanoseconds time);
  void report_overload();
  SimulationReport::Phase phase() const;
  void skip_to(Nanoseconds time);
  void go_on_from(Nanoseconds time);
  void start_waiting_cables();
  void publish();
  void announce(std::uint8_t type, const EventSubject& subject, const std::string& message) const;
  std::optional<EditResult> refused_frame(const std::string& key, const std::string& frame) const;
  EditResult place(const AddedObstacle& added);
  void place_added_obstacles();
  std::size_t find_frame_id(const std::string& frame) const;

  SceneDesc scene_;
  BackgroundTasks tasks_;
  double build_time_ = 0;  ///< [s] that the last world took to build
  TimeGrid grid_;
  Pacer pacer_;
  ClockWatch clock_;
  World world_;
  TfInputs frames_;
  Publishers publishers_;
  EventPublisher events_;
  FrameWatch frame_watch_;
  MissingFrames missing_frames_;
  CableWatch cable_watch_;
  AttachmentMoves moves_;

  std::map<std::string, Snapshot> snapshots_;
  std::map<std::string, AddedObstacle> added_obstacles_;
  Nanoseconds stamp_ = 0;
  Nanoseconds stepped_to_ = 0;   ///< the stamp after the last step; another one now: time was skipped
  Nanoseconds waits_since_ = 0;  ///< ROS time since which the start waits for frames; 0 before there was any
  bool started_ = false;
  bool keeps_world_ = false;  ///< the next start goes on with the world as it is
  bool paused_ = false;
  bool faulted_ = false;
  bool waits_for_frames_ = false;
  int scene_version_ = 0;
  ros::WallTime last_published_;
  OverloadWatch overload_watch_;
  Statistics statistics_;
  std::deque<AwaitedSteps> awaited_steps_;
  std::optional<Start> start_;
  std::list<Rebuild> rebuilds_;  ///< in the order they were asked for
};

}  // namespace verlet_cable

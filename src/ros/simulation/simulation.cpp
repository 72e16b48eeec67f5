#include "simulation/simulation.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "time/ros_time.h"
#include "verlet_cable/core/number_text.h"

namespace verlet_cable {
namespace {

/// Longer waits than this [s] cannot be caught up: tf would have forgotten the frames.
constexpr double longest_wait = 50;
/// Between messages while the clock stands: whoever subscribes then sees something.
const ros::WallDuration standing_period(0.5);

}  // namespace

const ros::WallDuration Simulation::longest_slice(0.01);

Nanoseconds Simulation::longest_backlog(const SceneDesc& scene) {
  return nanoseconds(std::min(scene.tf_timeout, longest_wait));
}

Simulation::Simulation(ros::NodeHandle& private_node, const SceneDesc& scene)
    : scene_(scene),
      grid_(scene.time_step, scene.publish_rate),
      pacer_(grid_, longest_backlog(scene)),
      world_(scene),
      frames_(private_node, scene),
      publishers_(private_node, scene),
      events_(private_node, scene.frame_id),
      frame_watch_(scene_, events_),
      cable_watch_(events_) {}

void Simulation::update(ros::WallDuration longest) {
  if (clock_.update() == ClockWatch::Motion::back) jump_back();
  frames_.receive(clock_.now());
  finish_rebuilds();
  if (!started_) return start_if_possible();
  missing_frames_.warn(scene_, world_, frames_);
  if (!awaited_steps_.empty()) return do_awaited_steps(longest);
  if (waits_for_frames_ && !paused_) continue_if_frames_are_back();
  if (paused_ || faulted_ || waits_for_frames_) {
    stand();
  } else {
    catch_up(longest);
  }
}

Nanoseconds Simulation::target() const {
  return clock_.now() - nanoseconds(scene_.tf_latency);
}

void Simulation::jump_back() {
  // What was collected before the jump belongs to the time before it.
  const bool forget = scene_.on_time_jump == TimeJumpPolicy::reset;
  interrupt_steps("ROS time went back");
  forget_resets("ROS time went back");
  publishers_.forget_steps();
  frames_.restart(clock_.now(), forget);
  if (started_) {
    stamp_ = std::max<Nanoseconds>(target(), 0);
    announce(CableEvent::TIME_JUMP, {},
             std::string("ROS time jumped back: ") +
                 (forget ? "everything is reset (on_time_jump: reset)" : "everything keeps its state (on_time_jump: keep)"));
  }
  // The frames of pins are forgotten, and so must be the world that has them.
  if (forget) use_world(World(scene_));
  start_.reset();
  keeps_world_ = (started_ || keeps_world_) && !forget;
  started_ = false;
  waits_since_ = 0;
}

/// The first time at which all frames are known is a property of the frames alone, and so is a run that starts then. Frames that
/// do not show up within `tf_timeout` are not waited for.
void Simulation::start_if_possible() {
  if (clock_.now() == 0) return;
  if (start_) {
    if (start_->build.is_ready()) finish_start();
    return;
  }
  if (waits_since_ == 0) waits_since_ = clock_.now();
  const bool late = clock_.now() - waits_since_ > nanoseconds(scene_.tf_timeout) || clock_.stands();
  const Nanoseconds common = frames_.first_common_time();
  if (!late && !frames_.all_seen()) return;
  const bool anchored = frames_.all_seen() && common > 0;
  const Nanoseconds time = grid_.tick_at_or_after(std::max<Nanoseconds>(anchored ? common : target() - grid_.period(), 1));
  if (late || time <= target()) prepare_start(time);
}

void Simulation::sample_at_start(Nanoseconds time) {
  if (!keeps_world_) frames_.reset(time);
  frames_.sample_at_once(time);
}

/// With the world that is there, and the frames that were sampled for it.
void Simulation::start(Nanoseconds time) {
  stamp_ = time;
  started_ = true;
  if (!keeps_world_) {
    // Frames of obstacles that came before the start are numbered anew, together with the new world's.
    frames_.drop_pinned_frames();
    world_.start_waiting(frames_.inputs());
    moves_.clear();
    place_added_obstacles();
    frame_watch_.forget_from(0);
    faulted_ = false;
    cable_watch_.restart(stamp_, world_);
  }
  waits_for_frames_ = frame_watch_.react(frames_.changes(), stamp_, world_);
  missing_frames_.report(world_, frames_);
  publish();
}

void Simulation::catch_up(ros::WallDuration longest) {
  const ros::WallTime deadline = ros::WallTime::now() + longest;
  stamp_ = pacer_.resume(stamp_, target());
  std::vector<bool> awaited = awaited_frames(world_);
  for (auto time = pacer_.next(stamp_, target()); time && ros::WallTime::now() < deadline; time = pacer_.next(stamp_, target())) {
    const Nanoseconds before = stamp_;
    if (!do_step(*time, awaited)) {
      pacer_.rest();
      break;
    }
    pacer_.done(before, stamp_, target());
  }
  report_overload();
  if (clock_.stands() && ros::WallTime::now() - last_published_ >= standing_period) publish();
}

/// One step of catching up, to `time`. False where it cannot be done now.
bool Simulation::do_step(Nanoseconds time, std::vector<bool>& awaited) {
  if (!frames_.sample(time, time - stamp_, target(), awaited)) return false;
  if (!frames_.changes().empty()) {
    waits_for_frames_ = frame_watch_.react(frames_.changes(), stamp_, world_);
    if (waits_for_frames_) return false;
  }
  if (!step_world(time)) return false;
  if (!frames_.changes().empty()) awaited = awaited_frames(world_);
  return true;
}

void Simulation::continue_if_frames_are_back() {
  const auto back = frames_.back_after(stamp_ + grid_.step(), needed_frames(world_));
  if (!back) return;
  waits_for_frames_ = false;
  // From the first step on that knows them all; where nothing holds the simulation any more, from where it should be.
  skip_to(*back > 0 ? grid_.step_at_or_after(*back) - grid_.step() : grid_.step_at_or_before(target()));
}

void Simulation::stand() {
  if (ros::WallTime::now() - last_published_ >= ros::WallDuration(seconds(grid_.period()))) publish();
}

/// False, and the world stands, after a fault.
bool Simulation::step_world(Nanoseconds time) {
  const auto begin = std::chrono::steady_clock::now();
  moves_.advance(scene_.time_step, world_);
  if (stamp_ != stepped_to_) frame_watch_.skip(world_.time());
  if (time - stamp_ > grid_.step()) world_.note_left_out_time();
  const StepResult result = world_.step(frames_.inputs());
  statistics_.add(result, world_.findings(), std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  if (result.ignored_frame >= 0) frame_watch_.warn_of_ignored(world_, frames_.inputs());
  cable_watch_.report_status(result, stamp_, world_);
  faulted_ = result.status == StepResult::Status::fault;
  if (faulted_) return false;
  publishers_.note_step(world_);
  const Nanoseconds before = std::exchange(stamp_, time);
  stepped_to_ = stamp_;
  frame_watch_.report_jumps(stamp_, world_);
  cable_watch_.report_events(stamp_, world_);
  cable_watch_.report_statuses(result, stamp_, world_);
  if (!frames_.changes().empty()) start_waiting_cables();
  if (grid_.passes_tick(before, stamp_)) publish();
  return true;
}

void Simulation::start_waiting_cables() {
  if (world_.findings().waiting.empty()) return;
  const Findings& findings = world_.findings();
  const StartsReported before{findings.unsettled.size(), findings.misfits.size(), findings.unreached.size()};
  world_.start_waiting(frames_.inputs());
  cable_watch_.report_starts(before, stamp_, world_);
}

void Simulation::report_overload() {
  const auto overload = overload_watch_.look(target(), pacer_.left_out(), ros::WallTime::now().toSec());
  if (!overload) return;
  ROS_WARN(
      "cannot keep up: the cables move at %.2g of real time (%.2g s dropped); a larger time_step, fewer segments or less contact "
      "would help",
      overload->real_time_factor, overload->left_out);
}

void Simulation::skip_to(Nanoseconds time) {
  if (time <= stamp_) return;
  pacer_.drop(time - stamp_);
  stamp_ = time;
}

/// After a pause, in which steps or a snapshot may have led beyond ROS time.
void Simulation::go_on_from(Nanoseconds time) {
  if (time >= stamp_) return skip_to(time);
  const double ahead = seconds(stamp_ - time);
  stamp_ = std::max<Nanoseconds>(time, 0);
  pacer_.rest();
  publishers_.forget_steps();
  announce(CableEvent::TIME_JUMP, {},
           "the simulated time was " + number_text(ahead) + " s ahead of ROS time, and goes back to it");
}

void Simulation::publish() {
  last_published_ = ros::WallTime::now();
  publishers_.publish(world_, to_ros_time(stamp_));
}

void Simulation::announce(std::uint8_t type, const EventSubject& subject, const std::string& message) const {
  events_.publish(type, stamp_, subject, message);
}

std::optional<Pose> Simulation::find_frame(const std::string& frame) const {
  const std::vector<std::string>& names = world_.frames();
  const auto found = std::find(names.begin(), names.end(), frame);
  const auto id = static_cast<std::size_t>(found - names.begin());
  const int number = static_cast<int>(id);
  if (id < names.size() && world_.is_body_frame(number))
    return world_.frame_known(number) ? std::optional<Pose>(world_.frame_pose(number)) : std::nullopt;
  if (id == 0 || (id < names.size() && frames_.inputs()[id].known)) return world_.frame_pose(number);
  return frames_.find(frame, stamp_);
}

Pose Simulation::attachment_pose(const Attachment& attachment) const {
  const Pose* const target = moves_.target(attachment.name);
  return world_.frame_pose(attachment.frame) * (target ? *target : attachment.pose);
}

SimulationReport::Phase Simulation::phase() const {
  using Phase = SimulationReport::Phase;
  if (faulted_) return Phase::faulted;
  if (!started_) return start_ ? Phase::building : clock_.now() == 0 ? Phase::no_time : Phase::awaits_first_frames;
  if (paused_) return Phase::paused;
  return waits_for_frames_ ? Phase::awaits_lost_frame : Phase::running;
}

SimulationReport Simulation::take_report() {
  const Nanoseconds behind = phase() == SimulationReport::Phase::running ? std::max<Nanoseconds>(target() - stamp_, 0) : 0;
  return {phase(), std::exchange(statistics_, {}), behind, pacer_.dropped(), cable_watch_.faults(), cable_watch_.intrusions()};
}

}  // namespace verlet_cable

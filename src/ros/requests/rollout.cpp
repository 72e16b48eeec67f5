#include "requests/rollout.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "frames/frame_buffer.h"
#include "publish/conversions.h"
#include "requests/requested.h"
#include "verlet_cable/core/name_list.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/quoted_text.h"
#include "verlet_cable/core/scene_fields.h"
#include "verlet_cable/scene/loads.h"

namespace verlet_cable {
namespace {

constexpr double longest_duration = 3600;  // [s]
constexpr double most_steps = 1e7;
/// Nodes in all the states of a result: about 100 MB.
constexpr double most_nodes = 1e6;
constexpr std::size_t most_transforms = 200'000;  // of a motion: an hour of a frame at 50 Hz
constexpr std::size_t most_errors = 20;
constexpr std::size_t most_loads = 200'000;

using LoadMessage = RolloutGoal::_loads_type::value_type;

int count_nodes(const World& world) {
  int nodes = 0;
  for (const SimulatedCable& cable : world.cables()) nodes += cable.state.nodes();
  for (const SimulatedNet& net : world.nets()) nodes += net.model.nodes();
  nodes += static_cast<int>(world.particles().size() + world.bodies().size());
  return nodes;
}

void check_times(const RolloutGoal& goal, const World& world, std::vector<std::string>& errors) {
  const double step = world.time_step();
  const double longest = std::min(longest_duration, most_steps * step);
  if (!(goal.duration > 0 && goal.duration <= longest))
    errors.push_back("duration: " + number_text(goal.duration) + "; allowed: above 0, at most " + number_text(longest) + " s");
  if (!(goal.rate > 0 && goal.rate * step <= 1 + 1e-9)) {
    errors.push_back("rate: " + number_text(goal.rate) + "; allowed: above 0, at most one state a step, " +
                     rounded_text(1 / step) + " Hz");
  } else if (goal.duration * goal.rate * count_nodes(world) > most_nodes) {
    errors.push_back("rate: " + number_text(goal.rate) + " for " + number_text(goal.duration) + " s of " +
                     std::to_string(count_nodes(world)) + " nodes; allowed: at most " + number_text(most_nodes) +
                     " nodes in all states");
  }
}

/// What a motion moves: the frames that hold something, without the fixed frame, which is the first, and those of bodies.
std::string moved_frames(const World& world) {
  NameList names;
  for (std::size_t i = 1; i < world.frames().size(); ++i)
    if (!world.is_body_frame(static_cast<int>(i))) names.add(world.frames()[i]);
  return names.text("none, no frame holds anything");
}

/// The motions by frame id. Problems are added to `errors`, each with its place in the goal.
std::map<int, FrameTrack> read_motion(const RolloutGoal& goal, const World& world, std::vector<std::string>& errors) {
  std::map<int, FrameTrack> motion;
  if (goal.motion.size() > most_transforms) {
    errors.push_back("motion: " + std::to_string(goal.motion.size()) + " transforms; allowed: at most " +
                     std::to_string(most_transforms));
    return motion;
  }
  const std::vector<std::string>& names = world.frames();
  for (std::size_t i = 0; i < goal.motion.size() && errors.size() < most_errors; ++i) {
    const std::string key = "motion[" + std::to_string(i) + "]";
    ReceivedTransform received{goal.motion[i], true};
    geometry_msgs::TransformStamped& transform = received.transform;
    if (transform.header.frame_id.empty()) transform.header.frame_id = names.front();
    const std::string problem = transform_problem(received);
    const auto frame = std::find(names.begin() + 1, names.end(), transform.child_frame_id);
    if (transform.header.frame_id != names.front()) {
      errors.push_back(key + ".header.frame_id: " + verlet_cable::in_quotes(transform.header.frame_id) +
                       "; allowed: the fixed frame " + verlet_cable::in_quotes(names.front()) + ", or empty");
    } else if (frame == names.end() || world.is_body_frame(static_cast<int>(frame - names.begin()))) {
      errors.push_back(key + ".child_frame_id: " + verlet_cable::in_quotes(transform.child_frame_id) +
                       "; allowed: " + moved_frames(world));
    } else if (!problem.empty()) {
      errors.push_back(key + ": " + problem);
    } else {
      FrameTrack& track = motion[static_cast<int>(frame - names.begin())];
      const double time = transform.header.stamp.toSec();
      if (!track.empty() && time <= track.last_time()) {
        errors.push_back(key + ".header.stamp: " + number_text(time) + " s; allowed: above that of the frame's last one, " +
                         number_text(track.last_time()) + " s");
        continue;
      }
      const auto& t = transform.transform.translation;
      const auto& r = transform.transform.rotation;
      track.add(time, {Vector3(t.x, t.y, t.z), Quaternion(r.w, r.x, r.y, r.z).normalized()});
    }
  }
  return motion;
}

/// In terms of the world from which the rollout starts. Problems are added to `errors`, each with its place in the goal.
std::vector<TimedLoad> read_loads(const RolloutGoal& goal, const World& world, std::vector<std::string>& errors) {
  std::vector<TimedLoad> loads;
  if (goal.loads.size() > most_loads) {
    errors.push_back("loads: " + std::to_string(goal.loads.size()) + " of them; allowed: at most " + std::to_string(most_loads));
    return loads;
  }
  const FindFrame find_frame = [&](const std::string& name) -> std::optional<Pose> {
    const auto found = std::find(world.frames().begin(), world.frames().end(), name);
    const int frame = static_cast<int>(found - world.frames().begin());
    if (found == world.frames().end() || !world.frame_known(frame)) return std::nullopt;
    return world.frame_pose(frame);
  };
  for (std::size_t i = 0; i < goal.loads.size() && errors.size() < most_errors; ++i) {
    const LoadMessage& given = goal.loads[i];
    const std::string key = "loads[" + std::to_string(i) + "].";
    const bool on_body = find(world.bodies(), given.location.cable) >= 0;
    CheckedLoad checked =
        check_load(requested_load(given.name, given.frame_id, given.point, given.wrench, given.duration, on_body),
                   locate_node(requested_place(given.location), world, find_frame), world, find_frame);
    if (!load_duration.contains(given.start))
      checked.errors.push_back("start: " + number_text(given.start) + "; allowed: " + load_duration.text("s"));
    for (const std::string& error : checked.errors) errors.push_back(key + error);
    loads.push_back({given.start, std::move(checked.load)});
  }
  std::stable_sort(loads.begin(), loads.end(), [](const TimedLoad& a, const TimedLoad& b) { return a.start < b.start; });
  return loads;
}

}  // namespace

Rollout::Rollout(const RolloutGoal& goal, RolloutStart start)
    : world_(std::move(start.world)), frames_(std::move(start.frames)), duration_(goal.duration), rate_(goal.rate) {
  std::vector<std::string> errors;
  check_times(goal, world_, errors);
  motion_ = read_motion(goal, world_, errors);
  loads_ = read_loads(goal, world_, errors);
  if (!errors.empty()) throw SceneError(std::move(errors));
  for (auto& [frame, track] : motion_) track.find_jumps(start.jump_speed);
  all_steps_ = std::llround(duration_ / world_.time_step());
}

void Rollout::begin() {
  follow(0);
  world_.start_waiting(frames_);
  record();
  if (all_steps_ == 0) end(true, "1 states");
}

double Rollout::progress() const {
  return all_steps_ > 0 ? static_cast<double>(steps_) / static_cast<double>(all_steps_) : 1;
}

/// Those that start with the next step. What has lost its node meanwhile, as a cable broke, is left out.
void Rollout::apply_loads() {
  for (; next_load_ < loads_.size() && is_due(loads_[next_load_].start, time(), world_.time_step()); ++next_load_)
    world_.apply(loads_[next_load_].load);
}

WorldStep Rollout::next_step() {
  apply_loads();
  ++steps_;
  follow(time());
  return {&world_, &frames_, {}};
}

void Rollout::take(const StepResult& done) {
  if (done.status == StepResult::Status::fault) return end(false, "the simulation failed after " + rounded_text(time()) + " s");
  // Half a step's tolerance: states are those of the steps nearest to their times.
  const auto recorded = static_cast<double>(result_.states.size());
  if ((time() + 0.5 * world_.time_step()) * rate_ >= recorded) record();
  if (steps_ == all_steps_) end(true, std::to_string(result_.states.size()) + " states");
}

void Rollout::cancel() {
  end(false, "cancelled after " + rounded_text(time()) + " s");
}

void Rollout::follow(double time) {
  for (const auto& [frame, track] : motion_) frames_[frame] = {track.at(time), true, track.velocity_from(time)};
}

void Rollout::record() {
  CableArray state = to_message(world_);
  state.header.stamp.fromSec(time());
  state.header.frame_id = world_.frames().front();
  result_.states.push_back(std::move(state));
}

void Rollout::end(bool success, const std::string& message) {
  ended_ = true;
  result_.success = success;
  result_.message = message;
}

}  // namespace verlet_cable

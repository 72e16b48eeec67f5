#include "requests/rollout.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "frames/frame_buffer.h"
#include "publish/conversions.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/quoted_text.h"

namespace verlet_cable {
namespace {

constexpr double longest_duration = 3600;  // [s]
constexpr double most_steps = 1e7;
/// Nodes in all the states of a result: about 100 MB.
constexpr double most_nodes = 1e6;
constexpr std::size_t most_errors = 20;

int count_nodes(const World& world) {
  int nodes = 0;
  for (const SimulatedCable& cable : world.cables()) nodes += cable.state.nodes();
  for (const SimulatedNet& net : world.nets()) nodes += net.model.nodes();
  nodes += static_cast<int>(world.particles().size());
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

/// The motions by frame id. Problems are added to `errors`, each with its place in the goal.
std::map<int, FrameTrack> read_motion(const RolloutGoal& goal, const World& world, std::vector<std::string>& errors) {
  std::map<int, FrameTrack> motion;
  const std::vector<std::string>& names = world.frames();
  for (std::size_t i = 0; i < goal.motion.size() && errors.size() < most_errors; ++i) {
    const std::string key = "motion[" + std::to_string(i) + "]";
    ReceivedTransform received{goal.motion[i], true};
    geometry_msgs::TransformStamped& transform = received.transform;
    if (transform.header.frame_id.empty()) transform.header.frame_id = names.front();
    const std::string problem = transform_problem(received);
    const auto frame = std::find(names.begin() + 1, names.end(), transform.child_frame_id);
    if (transform.header.frame_id != names.front()) {
      errors.push_back(key + ".header.frame_id: " + verlet_cable::quoted(transform.header.frame_id) +
                       "; allowed: the fixed frame " + verlet_cable::quoted(names.front()) + ", or empty");
    } else if (frame == names.end()) {
      errors.push_back(key + ".child_frame_id: " + verlet_cable::quoted(transform.child_frame_id) +
                       "; allowed: frames that hold something");
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

}  // namespace

Rollout::Rollout(const RolloutGoal& goal, RolloutStart start)
    : world_(std::move(start.world)), frames_(std::move(start.frames)), duration_(goal.duration), rate_(goal.rate) {
  std::vector<std::string> errors;
  check_times(goal, world_, errors);
  motion_ = read_motion(goal, world_, errors);
  if (!errors.empty()) throw SceneError(std::move(errors));
  world_.step_one_by_one(true);
}

bool Rollout::run(const std::function<bool(double)>& goes_on, RolloutResult& result) {
  const double step = world_.time_step();
  const auto steps = static_cast<std::int64_t>(std::llround(duration_ / step));
  const auto follow = [&](double time) {
    for (const auto& [frame, track] : motion_) frames_[frame] = {track.at(time), true, track.velocity_from(time)};
  };
  follow(0);
  world_.start_waiting(frames_);
  record(0, result);
  std::int64_t recorded = 1;
  for (std::int64_t i = 1; i <= steps; ++i) {
    const double time = static_cast<double>(i) * step;
    follow(time);
    const StepResult done = world_.step(frames_);
    if (done.status == StepResult::Status::fault) {
      result.message = "the simulation failed after " + rounded_text(time) + " s";
      return false;
    }
    // Half a step's tolerance: states are those of the steps nearest to their times.
    const bool is_due = (time + 0.5 * step) * rate_ >= static_cast<double>(recorded);
    if (is_due) {
      record(time, result);
      ++recorded;
    }
    if (!goes_on(static_cast<double>(i) / static_cast<double>(steps))) {
      result.message = "cancelled after " + rounded_text(time) + " s";
      return false;
    }
  }
  result.success = true;
  result.message = std::to_string(result.states.size()) + " states";
  return true;
}

void Rollout::record(double time, RolloutResult& result) const {
  CableArray state = to_message(world_);
  state.header.stamp.fromSec(time);
  state.header.frame_id = world_.frames().front();
  result.states.push_back(std::move(state));
}

}  // namespace verlet_cable

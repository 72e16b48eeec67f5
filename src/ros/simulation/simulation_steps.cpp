#include <string>
#include <utility>

#include "simulation/simulation.h"
#include "time/ros_time.h"

namespace verlet_cable {
namespace {

/// As many as anybody waits for.
constexpr std::int64_t most_steps = 1000000;

}  // namespace

void Simulation::step(std::int64_t steps, const Answer& answer) {
  const auto refuse = [&](const std::string& message) { answer({false, message, {}}); };
  if (!started_) return answer(refused_before_start());
  if (!paused_) return refuse("the simulation is not paused; step is for a paused one: call pause first");
  if (faulted_) return refuse("the simulation has failed: call reset first");
  if (steps < 1 || steps > most_steps)
    return refuse("steps: " + std::to_string(steps) + "; allowed: 1 to " + std::to_string(most_steps));
  if (steps > (last_ros_time - stamp_) / grid_.step())
    return refuse("steps: " + std::to_string(steps) + "; allowed: what ends before the last ROS time there is");
  awaited_steps_.push_back({steps, 0, answer});
  if (awaited_steps_.size() == 1) do_awaited_steps(longest_slice);
}

void Simulation::do_awaited_steps(ros::WallDuration longest) {
  const ros::WallTime deadline = ros::WallTime::now() + longest;
  while (!awaited_steps_.empty() && ros::WallTime::now() < deadline) {
    frames_.sample_without_waiting(stamp_ + grid_.step(), grid_.step());
    frame_watch_.react(frames_.changes(), stamp_, world_);
    if (!step_world(stamp_ + grid_.step())) return interrupt_steps("the simulation failed, call reset");
    AwaitedSteps& run = awaited_steps_.front();
    if (++run.done < run.asked) continue;
    if (!grid_.is_tick(stamp_)) publish();
    const AwaitedSteps ended = std::move(run);
    awaited_steps_.pop_front();
    ended.answer({true, std::to_string(ended.asked) + " steps done", {}});
  }
}

void Simulation::interrupt_steps(const std::string& reason) {
  for (const AwaitedSteps& run : std::exchange(awaited_steps_, {})) {
    run.answer(
        {false, "interrupted after " + std::to_string(run.done) + " of " + std::to_string(run.asked) + " steps: " + reason, {}});
  }
}

}  // namespace verlet_cable

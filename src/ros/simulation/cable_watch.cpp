#include "simulation/cable_watch.h"

#include "verlet_cable/core/body_name.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/quoted_text.h"

namespace verlet_cable {
namespace {

/// Between warnings about what may last [s].
constexpr double log_period = 5;
constexpr std::size_t most_intrusions = 1000;  // that are remembered: who sends obstacles may name each anew

}  // namespace

void CableWatch::report_status(const StepResult& result, Nanoseconds stamp, const World& world) {
  const std::string subject = name_of(world, result.body);
  if (result.status == StepResult::Status::fault) {
    ++faults_;
    events_.publish(CableEvent::FAULT, stamp, {subject, {}, result.node, {}},
                    "the simulation of " + quoted(subject) + " failed at node " + std::to_string(result.node) +
                        " and has stopped; call reset or restore_state to go on");
  }
  if (result.status == StepResult::Status::overstretched) {
    ROS_WARN_THROTTLE(
        log_period,
        "%s is overstretched at node %d: the points that hold it are further apart than the material between them is long",
        quoted(subject).c_str(), result.node);
  }
  if (result.exhausted) {
    ROS_WARN_THROTTLE(log_period,
                      "a step took too much work and was cut short, so that others need not wait: %s moves too violently for "
                      "the time_step, a shorter one or slower frames would help",
                      quoted(subject).c_str());
  } else if (result.status == StepResult::Status::degraded && (result.body.is_cable() || result.body.is_rigid_body())) {
    ROS_WARN_THROTTLE(log_period,
                      "no solution was found for a step of %s: its motion was taken away, and it goes on from rest; or it is in "
                      "another, and has no room to get apart",
                      quoted(subject).c_str());
  } else if (result.status == StepResult::Status::degraded) {
    ROS_WARN_THROTTLE(log_period,
                      "%s is unstable and was softened or stopped: stiff springs between light nodes need a shorter time_step",
                      quoted(subject).c_str());
  }
}

void CableWatch::report_events(Nanoseconds stamp, const World& world) const {
  for (const WorldEvent& event : events_of_step(world)) events_.publish(event, stamp);
}

void CableWatch::report_intrusions(const World& world) {
  for (const Intrusion& intrusion : world.findings().intrusions) {
    const std::string& cable = world.cables()[intrusion.cable].model->name;
    const std::string& obstacle = world.obstacles()[intrusion.obstacle].name;
    if (intrusions_.size() >= most_intrusions) return;
    if (!intrusions_.insert(escaped(cable) + " in " + escaped(obstacle)).second) continue;
    ROS_WARN("cable %s is %s m deep inside obstacle %s at segment %d and is pushed out of it", quoted(cable).c_str(),
             rounded_text(intrusion.depth).c_str(), quoted(obstacle).c_str(), intrusion.segment);
  }
}

void CableWatch::report_starts(std::size_t first_unsettled, std::size_t first_misfit, const World& world) const {
  for (std::size_t i = first_misfit; i < world.findings().misfits.size(); ++i)
    ROS_WARN(
        "the initial shape of cable %s does not fit its attachments and junctions: it hangs between them instead, in a "
        "loop where it is joined with itself",
        quoted(world.findings().misfits[i]).c_str());
  for (std::size_t i = first_unsettled; i < world.findings().unsettled.size(); ++i)
    ROS_WARN("cable %s: no static equilibrium was found to start from; it starts at rest near one, and may move at first",
             quoted(world.findings().unsettled[i]).c_str());
}

void CableWatch::restart(const World& world) {
  intrusions_.clear();
  report_starts(0, 0, world);
}

}  // namespace verlet_cable

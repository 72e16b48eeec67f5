#include "simulation/cable_watch.h"

#include "verlet_cable/core/body_name.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/quoted_text.h"

namespace verlet_cable {
namespace {

constexpr std::size_t most_intrusions = 1000;  // that are remembered: who sends obstacles may name each anew

}  // namespace

void CableWatch::report_status(const StepResult& result, Nanoseconds stamp, const World& world) {
  if (result.status == StepResult::Status::fault) {
    ++faults_;
    const std::string subject = name_of(world, result.body);
    events_.publish(CableEvent::FAULT, stamp, {subject, {}, result.node, {}},
                    "the simulation of " + in_quotes(subject) + " failed at node " + std::to_string(result.node) +
                        " and has stopped; call reset or restore_state to go on");
  }
}

void CableWatch::report_events(Nanoseconds stamp, const World& world) const {
  for (const WorldEvent& event : events_of_step(world)) events_.publish(event, stamp);
}

void CableWatch::report_statuses(const StepResult& result, Nanoseconds stamp, const World& world) {
  const auto remember = [&](const std::string& name, int obstacle) {
    if (intrusions_.size() < most_intrusions)
      intrusions_.insert(escaped(name) + " in " + escaped(world.obstacles()[obstacle].name));
  };
  for (const Intrusion& found : world.findings().intrusions) remember(world.cables()[found.cable].model->name, found.obstacle);
  for (const BodyIntrusion& found : world.findings().body_intrusions) remember(world.bodies()[found.body].name, found.obstacle);
  statuses_.observe(world, result, {});
  if (!statuses_.is_empty()) publish(stamp, world.time());
}

/// At `stamp` the world's time is `time` [s], if there still is one; else all is as of now. Faults have a type of their own, and
/// frames are watched elsewhere.
void CableWatch::publish(Nanoseconds stamp, std::optional<double> time) {
  for (const StatusEvent& event : statuses_.take())
    if (!event.cable.empty() && event.name != name_of(EventType::fault))
      events_.publish(event, time ? stamp + nanoseconds(event.time - *time) : stamp);
}

void CableWatch::report_starts(const StartsReported& before, Nanoseconds stamp, const World& world) {
  for (std::size_t i = before.unreached; i < world.findings().unreached.size(); ++i)
    ROS_ERROR("a start out of reach: %s", world.findings().unreached[i].c_str());
  for (std::size_t i = before.misfits; i < world.findings().misfits.size(); ++i)
    ROS_WARN(
        "the initial shape of cable %s does not fit its attachments and junctions: it hangs between them instead, in a "
        "loop where it is joined with itself",
        in_quotes(world.findings().misfits[i]).c_str());
  statuses_.observe_start(world, before.unsettled);
  publish(stamp, world.time());
}

void CableWatch::restart(Nanoseconds stamp, const World& world) {
  end_statuses(stamp);
  intrusions_.clear();
  report_starts({}, stamp, world);
}

void CableWatch::end_statuses(Nanoseconds stamp) {
  statuses_.end_all();
  publish(stamp, std::nullopt);
}

}  // namespace verlet_cable

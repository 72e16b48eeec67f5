#include "simulation/event_record.h"

#include <utility>

#include "verlet_cable/core/body_name.h"
#include "verlet_cable/core/quoted_text.h"

namespace verlet_cable {
namespace {

constexpr std::size_t most_events = 1000;
/// [s] of a frame's jumps no more than one is told.
constexpr double jump_quiet_time = 1;

}  // namespace

void EventRecord::add(double time, WorldEvent event) {
  if (taken_.events.size() < most_events) {
    taken_.events.push_back({time, std::move(event)});
  } else {
    ++taken_.left_out;
    taken_.last_time = time;
  }
}

void EventRecord::add_all(const World& world, const StepResult& result) {
  const bool fault = result.status == StepResult::Status::fault;
  if (fault && !faulted_) {
    const std::string subject = name_of(world, result.body);
    add(world.time(), {EventType::fault,
                       {subject, {}, result.node, {}},
                       "the simulation of " + quoted(subject) + " failed at node " + std::to_string(result.node) +
                           ": it stays as it was last"});
  }
  faulted_ = fault;
  add_jumps(world);
  for (WorldEvent& event : events_of_step(world)) add(world.time(), std::move(event));
}

void EventRecord::add_jumps(const World& world) {
  for (const Jump& jump : world.findings().jumps) {
    WorldEvent event = jump_event(world, jump);
    const auto [told, is_new] = jumps_.emplace(event.subject.other, jump.time);
    if (!is_new && jump.time > told->second && jump.time - told->second < jump_quiet_time) continue;
    told->second = jump.time;
    add(jump.time, std::move(event));
  }
}

EventRecord::Taken EventRecord::take() {
  return std::exchange(taken_, {});
}

}  // namespace verlet_cable

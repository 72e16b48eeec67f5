#include "simulation/event_record.h"

#include <algorithm>
#include <utility>

namespace verlet_cable {
namespace {

constexpr std::size_t most_events = 1000;
/// [s] of a frame's jumps no more than one is told.
constexpr double jump_quiet_time = 1;

void write_event(const TimedEvent& event, ByteWriter& bytes) {
  bytes(event.time);
  bytes(event.subject.node);
  const EventSubject& subject = event.subject;
  for (const std::string* text : {&event.type, &subject.cable, &subject.attachment, &subject.other, &event.message})
    bytes.write_text(*text);
}

TimedEvent read_event(ByteReader& bytes) {
  TimedEvent event;
  bytes(event.time);
  bytes(event.subject.node);
  EventSubject& subject = event.subject;
  for (std::string* text : {&event.type, &subject.cable, &subject.attachment, &subject.other, &event.message})
    *text = bytes.read_text();
  return event;
}

}  // namespace

EventRecord::EventRecord(const std::string& data) {
  ByteReader bytes(data);
  for (std::size_t left = bytes.read_length(); left > 0; --left) taken_.events.push_back(read_event(bytes));
  bytes(taken_.left_out);
  bytes(taken_.last_time);
  for (std::size_t left = bytes.read_length(); left > 0; --left) {
    std::string frame = bytes.read_text();
    bytes(jumps_[std::move(frame)]);
  }
  statuses_ = StatusLog(bytes);
}

std::string EventRecord::save() const {
  ByteWriter bytes;
  bytes(taken_.events.size());
  for (const TimedEvent& event : taken_.events) write_event(event, bytes);
  bytes(taken_.left_out);
  bytes(taken_.last_time);
  bytes(jumps_.size());
  for (const auto& [frame, time] : jumps_) {
    bytes.write_text(frame);
    bytes(time);
  }
  statuses_.write(bytes);
  return bytes.take();
}

void EventRecord::add(TimedEvent event) {
  if (taken_.events.size() < most_events) {
    taken_.events.push_back(std::move(event));
  } else {
    ++taken_.left_out;
    taken_.last_time = event.time;
  }
}

void EventRecord::add(double time, const WorldEvent& event) {
  add({time, name_of(event.type), event.subject, event.message});
}

void EventRecord::add_misfits(const World& world) {
  for (const std::string& cable : world.findings().misfits)
    if (world.steps() == 0) add({world.time(), "not_fitted", {cable, {}, 0, {}}, misfit_text});
}

void EventRecord::observe_restored(const World& world) {
  add_misfits(world);
  statuses_.observe(world, {}, {});
  add_statuses();
}

void EventRecord::observe_start(const World& world) {
  add_misfits(world);
  statuses_.observe_start(world);
  add_statuses();
}

void EventRecord::add_all(const World& world) {
  add_statuses();
  add_jumps(world);
  for (const WorldEvent& event : events_of_step(world)) add(world.time(), event);
}

void EventRecord::add_statuses() {
  for (StatusEvent& event : statuses_.take())
    add({event.time,
         event.name + (event.has_ended ? "_end" : ""),
         {std::move(event.cable), {}, std::max(event.node, 0), std::move(event.other)},
         std::move(event.message)});
}

void EventRecord::add_jumps(const World& world) {
  for (const Jump& jump : world.findings().jumps) {
    const WorldEvent event = jump_event(world, jump);
    const auto [told, is_new] = jumps_.emplace(event.subject.other, jump.time);
    if (!is_new && jump.time > told->second && jump.time - told->second < jump_quiet_time) continue;
    told->second = jump.time;
    add(jump.time, event);
  }
}

EventRecord::Taken EventRecord::take() {
  Taken taken = std::exchange(taken_, {});
  std::stable_sort(taken.events.begin(), taken.events.end(),
                   [](const TimedEvent& a, const TimedEvent& b) { return a.time < b.time; });
  return taken;
}

}  // namespace verlet_cable

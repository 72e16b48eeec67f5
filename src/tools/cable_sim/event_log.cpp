#include "event_log.h"

#include <algorithm>
#include <cstdio>

#include "verlet_cable/core/body_name.h"
#include "verlet_cable/core/ended_load_text.h"
#include "verlet_cable/core/excursion_text.h"
#include "verlet_cable/core/jump_text.h"
#include "verlet_cable/core/number_text.h"

namespace verlet_cable::cable_sim {
namespace {

/// [s] of a frame's jumps no more than one is told.
constexpr double jump_quiet_time = 1;
constexpr std::size_t most_events = 1000;
constexpr std::size_t most_printed = 20;

}  // namespace

void EventLog::observe(const World& world, const StepResult& result, const std::vector<int>& held_back) {
  statuses_.observe(world, result, held_back);
  if (!statuses_.is_empty()) add_statuses();
  add_breaks(world);
  add_excursions(world);
  add_jumps(world);
  add_guides(world);
  add_ended_loads(world);
}

void EventLog::add_refused_loads(const World& world, const std::vector<RefusedLoad>& refused) {
  for (const RefusedLoad& load : refused) add({world.time(), "LOAD_ENDED", load.on, -1, "", load.message, load.name});
}

void EventLog::add_ended_loads(const World& world) {
  for (const EndedLoad& load : world.findings().ended_loads)
    add({world.time(), "LOAD_ENDED", load.on, -1, "", ended_load_text(load), load.name});
}

void EventLog::add_starts(const World& world) {
  for (const std::string& cable : world.findings().misfits) add({world.time(), "not_fitted", cable, -1, "", misfit_text, ""});
  statuses_.observe_start(world);
  add_statuses();
}

void EventLog::add_statuses() {
  for (const StatusEvent& event : statuses_.take()) {
    const bool is_frame = event.cable.empty();
    add({event.time, event.name + (event.has_ended ? "_end" : ""), event.cable, event.node, is_frame ? event.other : "",
         event.message, is_frame ? "" : event.other});
  }
}

std::vector<Event> EventLog::events() const {
  std::vector<Event> sorted = events_;
  std::stable_sort(sorted.begin(), sorted.end(), [](const Event& a, const Event& b) { return a.time < b.time; });
  if (dropped_ > 0) sorted.push_back({last_dropped_time_, "more", "", -1, "", std::to_string(dropped_) + " more events", ""});
  return sorted;
}

void EventLog::add_breaks(const World& world) {
  for (const Break& broken : world.findings().breaks) {
    const CableModel& first = *world.cables()[static_cast<std::size_t>(broken.cable)].model;
    const std::string& second = world.cables()[static_cast<std::size_t>(broken.new_cable)].model->name;
    add({world.time(), "BROKE", first.name, broken.segment, "",
         "the segment that starts here was pulled harder than " + number_text(broken.limit) +
             " N and is gone; the rest of the cable is " + second,
         second});
  }
}

void EventLog::add_excursions(const World& world) {
  for (const Excursion& excursion : world.findings().excursions)
    add({world.time(), "LIMIT", world.cables()[static_cast<std::size_t>(excursion.cable)].model->name, excursion.node, "",
         excursion_text(excursion), excursion.other});
}

void EventLog::add_jumps(const World& world) {
  for (const Jump& jump : world.findings().jumps) {
    const Attachment& attachment = world.attachments()[static_cast<std::size_t>(jump.attachment)];
    const std::string& frame = world.frames()[static_cast<std::size_t>(attachment.frame)];
    const auto [told, is_new] = jumps_.emplace(frame, jump.time);
    if (!is_new && jump.time > told->second && jump.time - told->second < jump_quiet_time) continue;
    told->second = jump.time;
    add({jump.time, "JUMPED", name_of(world, attachment.body), attachment.node, frame, jump_text(world, jump), ""});
  }
}

void EventLog::add_guides(const World& world) {
  const auto add_all = [&](const std::vector<int>& guides, const char* type, const char* message) {
    for (const int guide : guides) {
      const SimulatedGuide& g = world.guides()[static_cast<std::size_t>(guide)];
      add({world.time(), type, g.cable, -1, world.frames()[static_cast<std::size_t>(g.frame)], g.name + message, g.name});
    }
  };
  add_all(world.findings().caught, "CAUGHT", " has taken the cable");
  add_all(world.findings().released, "RELEASED", " has let the cable go");
}

void EventLog::add(const Event& event) {
  if (events_.size() >= most_events) {
    ++dropped_;
    last_dropped_time_ = event.time;
    return;
  }
  events_.push_back(event);
  if (events_.size() > most_printed) return;
  progress_.clear();
  const std::string where = event.cable.empty() ? event.frame
                            : event.node < 0    ? event.cable
                                                : event.cable + " node " + std::to_string(event.node);
  std::fprintf(stderr, "cable_sim: at %s s: %s: %s: %s\n", rounded_text(event.time, 6).c_str(), event.type.c_str(), where.c_str(),
               event.message.c_str());
  if (events_.size() == most_printed) std::fputs("cable_sim: further events are in the summary only\n", stderr);
}

}  // namespace verlet_cable::cable_sim

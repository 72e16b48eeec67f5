#include "event_log.h"

#include <algorithm>
#include <cstdio>

#include "verlet_cable/core/body_name.h"
#include "verlet_cable/core/excursion_text.h"
#include "verlet_cable/core/jump_text.h"
#include "verlet_cable/core/number_text.h"

namespace verlet_cable::cable_sim {
namespace {

/// [s] what does not come back for so long has ended; what comes and goes faster is one event.
constexpr double quiet_time = 0.1;
/// [s] of a frame's jumps no more than one is told.
constexpr double jump_quiet_time = 1;
constexpr std::size_t most_events = 1000;
constexpr std::size_t most_printed = 20;

struct StatusText {
  const char* type;
  const char* message;
};

StatusText text_of(StepResult::Status status) {
  switch (status) {
    case StepResult::Status::overstretched:
      return {"overstretched",
              "the points that hold it are further apart than the material between them is long; it is lengthened to reach"};
    case StepResult::Status::degraded:
      return {"degraded",
              "no solution was found for a step, or none without too much work, or it became unstable, and its motion was taken "
              "away; or its springs are too stiff for the time_step, and were softened"};
    case StepResult::Status::fault:
      return {"FAULT", "the simulation failed: it has no finite state any more"};
    case StepResult::Status::jumped:
    case StepResult::Status::ok:
      break;
  }
  return {"ok", ""};
}

}  // namespace

void EventLog::observe(const World& world, const StepResult& result, const std::vector<int>& held_back) {
  // A jump is told when it is over, by the frame's name.
  if (result.status != StepResult::Status::ok && result.status != StepResult::Status::jumped) {
    const StatusText text = text_of(result.status);
    const std::string cable = name_of(world, result.body);
    report({world.time(), text.type, cable, result.node, "", text.message, ""}, result.max_strain);
  }
  add_breaks(world);
  add_excursions(world);
  add_jumps(world);
  add_guides(world);
  add_intrusions(world);
  for (const int frame : held_back) {
    const std::string& name = world.frames()[static_cast<std::size_t>(frame)];
    report({world.time(), "frame_too_fast", "", -1, name,
            "the frame moves faster than max_frame_speed and is followed at that speed", ""},
           0);
  }
  if (result.ignored_frame >= 0)
    report({world.time(), "frame_out_of_range", "", -1, world.frames()[static_cast<std::size_t>(result.ignored_frame)],
            "the frame is further than 1e9 m from the origin along an axis; it is not followed there and stays where it was", ""},
           0);
  end_episodes(world.time());
}

void EventLog::add_starts(const World& world) {
  for (const std::string& cable : world.findings().misfits)
    add({world.time(), "not_fitted", cable, -1, "",
         "the initial shape does not fit the cable's attachments and junctions; it hangs between them instead, in a loop where "
         "it is joined with itself",
         ""});
  for (const std::string& cable : world.findings().unsettled)
    add({world.time(), "not_settled", cable, -1, "",
         "no static equilibrium was found; the cable starts at rest near one, and may move at first", ""});
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
         excursion_text(excursion), ""});
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

void EventLog::add_intrusions(const World& world) {
  for (const Intrusion& intrusion : world.findings().intrusions) {
    const std::string& cable = world.cables()[static_cast<std::size_t>(intrusion.cable)].model->name;
    const std::string& obstacle = world.obstacles()[static_cast<std::size_t>(intrusion.obstacle)].name;
    if (!intrusions_.emplace(cable, obstacle).second) continue;
    add({world.time(), "inside_obstacle", cable, intrusion.segment, "",
         "the segment that starts here is " + rounded_text(intrusion.depth) + " m deep inside " + obstacle + " and is pushed out",
         obstacle});
  }
}

void EventLog::report(const Event& event, double strain) {
  const auto [found, is_new] = episodes_.emplace(event.type + " " + event.cable + " " + event.frame, Episode{event});
  found->second.last_time = event.time;
  found->second.largest_strain = std::max(found->second.largest_strain, strain);
  if (is_new) add(event);
}

void EventLog::end_episodes(double time) {
  for (auto it = episodes_.begin(); it != episodes_.end();) {
    const Episode& episode = it->second;
    if (time - episode.last_time < quiet_time) {
      ++it;
      continue;
    }
    Event end = episode.first;
    end.time = episode.last_time;
    end.type += "_end";
    end.message = "ended, after " + rounded_text(episode.last_time - episode.first.time) + " s";
    if (episode.first.frame.empty()) end.message += "; largest strain " + rounded_text(episode.largest_strain);
    add(end);
    it = episodes_.erase(it);
  }
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

#include "world_events/status_log.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "verlet_cable/core/body_name.h"
#include "verlet_cable/core/number_text.h"
#include "world_events/world_event.h"

namespace verlet_cable {
namespace {

using Status = StepResult::Status;

/// [s] what does not come back for so long has ended; what comes and goes faster is one event.
constexpr double quiet_time = 0.1;

/// What happened, and what to do.
const char* message_of(DegradedCause cause) {
  switch (cause) {
    case DegradedCause::no_solution:
      return "no solution was found for a step, and its motion was taken away; use a shorter time_step";
    case DegradedCause::too_much_work:
      return "a step took too much work and was cut short; make it of fewer segments or links";
    case DegradedCause::unstable:
      return "it became unstable, and its motion was taken away; use a shorter time_step";
    case DegradedCause::too_stiff:
      return "its springs are too stiff for the time_step, and were softened; use a shorter time_step";
    case DegradedCause::no_room:
      return "it is pressed into something and has no room to get out; give it more room there";
    case DegradedCause::none:
      break;
  }
  return "";
}

const char* message_of(Status status) {
  switch (status) {
    case Status::overstretched:
      return "the points that hold it are further apart than the material between them is long; it is lengthened to reach";
    case Status::not_settled:
      return "no static equilibrium was found; the cable starts at rest near one, and may move at first";
    case Status::fault:
      return "the simulation failed: it has no finite state any more, and stays as it was last";
    case Status::degraded:
    case Status::inside_obstacle:
    case Status::jumped:
    case Status::ok:
      break;
  }
  return "";
}

StatusEvent event_of(const World& world, const StatusFinding& found) {
  const std::string name = found.status == Status::fault ? "FAULT" : name_of(found.status);
  const int node = found.status == Status::not_settled ? -1 : found.node;
  const char* message = found.status == Status::degraded ? message_of(found.cause) : message_of(found.status);
  return {world.time(), name, false, name_of(world, found.body), node, "", message};
}

StatusEvent event_of(const World& world, const Intrusion& found) {
  const std::string& obstacle = world.obstacles()[found.obstacle].name;
  return {world.time(),
          name_of(Status::inside_obstacle),
          false,
          world.cables()[found.cable].model->name,
          found.segment,
          obstacle,
          "the segment that starts here is " + rounded_text(found.depth) + " m deep inside " + obstacle + " and is pushed out"};
}

StatusEvent event_of(const World& world, const BodyIntrusion& found) {
  const std::string& obstacle = world.obstacles()[found.obstacle].name;
  return {world.time(),
          name_of(Status::inside_obstacle),
          false,
          world.bodies()[found.body].name,
          -1,
          obstacle,
          "it is " + rounded_text(found.depth) + " m deep inside " + obstacle + " and is pushed out"};
}

StatusEvent event_of(const World& world, const UnaccountedEnergy& found) {
  const std::string amount = rounded_text(std::abs(found.energy)) + " J";
  return {world.time(),
          name_of(EventType::energy),
          false,
          name_of(world, found.body),
          -1,
          "",
          found.energy > 0 ? amount + " came from nowhere in a step; use a shorter time_step, and see the ledger"
                           : amount + " got lost in a step; use a shorter time_step, and see the ledger"};
}

void write_event(const StatusEvent& event, ByteWriter& bytes) {
  bytes(event.time);
  bytes(event.has_ended);
  bytes(event.node);
  for (const std::string* text : {&event.name, &event.cable, &event.other, &event.message}) bytes.write_text(*text);
}

StatusEvent read_event(ByteReader& bytes) {
  StatusEvent event;
  bytes(event.time);
  bytes(event.has_ended);
  bytes(event.node);
  for (std::string* text : {&event.name, &event.cable, &event.other, &event.message}) *text = bytes.read_text();
  return event;
}

}  // namespace

const char* name_of(Status status) {
  switch (status) {
    case Status::ok:
      return "ok";
    case Status::jumped:
      return "jumped";
    case Status::overstretched:
      return "overstretched";
    case Status::inside_obstacle:
      return "inside_obstacle";
    case Status::not_settled:
      return "not_settled";
    case Status::degraded:
      return "degraded";
    case Status::fault:
      return "fault";
  }
  return "";
}

StatusLog::StatusLog(ByteReader& bytes) {
  for (std::size_t left = bytes.read_length(); left > 0; --left) {
    std::string key = bytes.read_text();
    Episode episode{read_event(bytes)};
    bytes(episode.last_time);
    bytes(episode.largest);
    episodes_.emplace(std::move(key), std::move(episode));
  }
  for (std::size_t left = bytes.read_length(); left > 0; --left) told_.push_back(read_event(bytes));
}

void StatusLog::write(ByteWriter& bytes) const {
  bytes(episodes_.size());
  for (const auto& [key, episode] : episodes_) {
    bytes.write_text(key);
    write_event(episode.first, bytes);
    bytes(episode.last_time);
    bytes(episode.largest);
  }
  bytes(told_.size());
  for (const StatusEvent& event : told_) write_event(event, bytes);
}

void StatusLog::observe_start(const World& world, std::size_t first_unsettled) {
  const std::vector<std::string>& unsettled = world.findings().unsettled;
  for (std::size_t i = first_unsettled; i < unsettled.size(); ++i)
    report({world.time(), name_of(Status::not_settled), false, unsettled[i], -1, "", message_of(Status::not_settled)}, 0);
}

void StatusLog::tell(const World& world, const StepResult& result, const std::vector<int>& held_back) {
  const double time = world.time();
  for (const StatusFinding& found : world.findings().statuses)
    if (found.status != Status::jumped && found.status != Status::inside_obstacle)
      report(event_of(world, found), found.max_strain);
  for (const Intrusion& found : world.findings().intrusions) report(event_of(world, found), found.depth);
  for (const BodyIntrusion& found : world.findings().body_intrusions) report(event_of(world, found), found.depth);
  for (const UnaccountedEnergy& found : world.findings().unaccounted) report(event_of(world, found), 0);
  for (const int frame : held_back)
    report({time, "frame_too_fast", false, "", -1, world.frames()[frame],
            "the frame moves faster than max_frame_speed and is followed at that speed"},
           0);
  if (result.ignored_frame >= 0)
    report({time, "frame_out_of_range", false, "", -1, world.frames()[result.ignored_frame],
            "the frame is further than 1e9 m from the origin along an axis; it is not followed there and stays where it was"},
           0);
  for (auto it = episodes_.begin(); it != episodes_.end();) {
    if (time - it->second.last_time < quiet_time) {
      ++it;
    } else {
      end(it->second);
      it = episodes_.erase(it);
    }
  }
}

void StatusLog::report(const StatusEvent& event, double size) {
  const auto [found, is_new] = episodes_.emplace(event.name + " " + event.cable + " " + event.other, Episode{event});
  found->second.last_time = event.time;
  found->second.largest = std::max(found->second.largest, size);
  if (is_new) told_.push_back(event);
}

void StatusLog::end(const Episode& episode) {
  if (episode.first.name == name_of(EventType::energy)) return;
  StatusEvent event = episode.first;
  event.time = episode.last_time;
  event.has_ended = true;
  event.message = "ended, after " + rounded_text(episode.last_time - episode.first.time) + " s";
  if (episode.largest > 0) {
    const bool is_depth = event.name == name_of(Status::inside_obstacle);
    event.message += (is_depth ? "; deepest " : "; largest strain ") + rounded_text(episode.largest) + (is_depth ? " m" : "");
  }
  told_.push_back(std::move(event));
}

void StatusLog::end_all() {
  for (const auto& [key, episode] : episodes_) end(episode);
  episodes_.clear();
}

std::vector<StatusEvent> StatusLog::take() {
  return std::exchange(told_, {});
}

}  // namespace verlet_cable

#include "world_events/world_event.h"

#include <algorithm>

#include "verlet_cable/core/body_name.h"
#include "verlet_cable/core/ended_load_text.h"
#include "verlet_cable/core/excursion_text.h"
#include "verlet_cable/core/jump_text.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/quoted_text.h"

namespace verlet_cable {
namespace {

WorldEvent event_of(const World& world, const Break& broken) {
  const std::string& first = world.cables()[broken.cable].model->name;
  const std::string& second = world.cables()[broken.new_cable].model->name;
  return {EventType::broke,
          {first, {}, broken.segment, second},
          "cable " + in_quotes(first) + " broke at segment " + std::to_string(broken.segment) +
              ", where its tension was above breaking_tension, " + number_text(broken.limit) +
              " N; the part behind it is now cable " + in_quotes(second)};
}

WorldEvent event_of(const World& world, const Excursion& excursion) {
  const std::string& cable = world.cables()[excursion.cable].model->name;
  return {EventType::limit,
          {cable, {}, excursion.node, excursion.other},
          "cable " + in_quotes(cable) + " at node " + std::to_string(excursion.node) + ": " + excursion_text(excursion)};
}

WorldEvent event_of(const World& world, int index, EventType type) {
  const SimulatedGuide& guide = world.guides()[index];
  const auto holds = [&](const Attachment& attachment) { return attachment.guide == index; };
  const auto attachment = std::find_if(world.attachments().begin(), world.attachments().end(), holds);
  const bool caught = type == EventType::caught;
  return {type,
          {guide.cable, guide.name, attachment == world.attachments().end() ? 0 : attachment->node, {}},
          "guide " + in_quotes(guide.name) + (caught ? " has taken cable " : " has let cable ") + in_quotes(guide.cable) +
              (caught ? "" : " go")};
}

}  // namespace

const char* name_of(EventType type) {
  switch (type) {
    case EventType::cut:
      return "CUT";
    case EventType::broke:
      return "BROKE";
    case EventType::pinned:
      return "PINNED";
    case EventType::unpinned:
      return "UNPINNED";
    case EventType::frame_lost:
      return "FRAME_LOST";
    case EventType::frame_back:
      return "FRAME_BACK";
    case EventType::reset:
      return "RESET";
    case EventType::time_jump:
      return "TIME_JUMP";
    case EventType::fault:
      return "FAULT";
    case EventType::joined:
      return "JOINED";
    case EventType::limit:
      return "LIMIT";
    case EventType::caught:
      return "CAUGHT";
    case EventType::released:
      return "RELEASED";
    case EventType::jumped:
      return "JUMPED";
    case EventType::energy:
      return "ENERGY";
    case EventType::load_ended:
      return "LOAD_ENDED";
  }
  return "";
}

EventSubject subject_of(const World& world, const Attachment& attachment) {
  return {name_of(world, attachment.body), attachment.name, attachment.node, world.frames()[attachment.frame]};
}

std::vector<WorldEvent> events_of_step(const World& world) {
  const Findings& findings = world.findings();
  std::vector<WorldEvent> events;
  for (const Break& broken : findings.breaks) events.push_back(event_of(world, broken));
  for (const Excursion& excursion : findings.excursions) events.push_back(event_of(world, excursion));
  for (const int guide : findings.caught) events.push_back(event_of(world, guide, EventType::caught));
  for (const int guide : findings.released) events.push_back(event_of(world, guide, EventType::released));
  for (const EndedLoad& load : findings.ended_loads)
    events.push_back({EventType::load_ended, {load.on, load.name, 0, {}}, ended_load_text(load)});
  return events;
}

WorldEvent jump_event(const World& world, const Jump& jump) {
  return {EventType::jumped, subject_of(world, world.attachments()[jump.attachment]), jump_text(world, jump)};
}

}  // namespace verlet_cable

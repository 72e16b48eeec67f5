#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// Numbers and names are those of CableEvent.msg.
enum class EventType : std::uint8_t {
  cut = 1,
  broke,
  pinned,
  unpinned,
  frame_lost,
  frame_back,
  reset,
  time_jump,
  fault,
  joined,
  limit,
  caught,
  released,
  jumped,
  energy,
  load_ended = 17
};

/// "CUT"
const char* name_of(EventType type);

/// What an event is about; what does not apply stays empty.
struct EventSubject {
  std::string cable;       ///< or the net or body
  std::string attachment;  ///< or the load
  int node = 0;
  std::string other;  ///< the new cable; the one that went; the frame
};

EventSubject subject_of(const World& world, const Attachment& attachment);

struct WorldEvent {
  EventType type;
  EventSubject subject;
  std::string message;
};

/// Cables that broke in the last step, those that came beyond their materials' limits, what guides took or let go, and loads that
/// have ended by themselves.
std::vector<WorldEvent> events_of_step(const World& world);

/// A jump that the last step found to be over.
WorldEvent jump_event(const World& world, const Jump& jump);

}  // namespace verlet_cable

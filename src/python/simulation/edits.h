#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "edit_requests/checked_load.h"
#include "edit_requests/checked_pin.h"
#include "edit_requests/named_edits.h"
#include "edit_requests/tunable_numbers.h"
#include "simulation/driven_world.h"
#include "simulation/event_record.h"

namespace verlet_cable {

// What the node's services do. What cannot be done throws, with the service's message in the words of Python's arguments, and
// changes nothing: UnknownName where only a name is wrong that something should have, std::invalid_argument else.

/// Of a place that Python's arguments give.
const RequestWords& python_words();

struct PinAnswer {
  std::string name;
  int node = 0;
};
/// A frame that is new is a robot's link where that is, or it rests at the origin.
PinAnswer pin(const RequestedPin& request, DrivenWorld& world, EventRecord& events);

void unpin(const std::string& name, DrivenWorld& world, EventRecord& events);

struct CutAnswer {
  std::string first, second;  ///< no second one of nets
};
CutAnswer cut(const RequestedPlace& place, DrivenWorld& world, EventRecord& events);

/// Returns the name of the cable.
std::string join(const std::string& first, bool first_at_end, const std::string& second, bool second_at_end, DrivenWorld& world,
                 EventRecord& events);

void set_length(const std::string& cable, bool at_end, double length, double speed, double max_tension, DrivenWorld& world);
void set_tension(const std::string& cable, const edit::SetTension& change, DrivenWorld& world);
/// Of cables, bodies and guides, all at once; what is not given stays.
void set_states(const std::vector<NamedState>& states, DrivenWorld& world);
void move_attachment(const std::string& name, const Pose& offset, DrivenWorld& world);

/// A load on a node of a cable, or on a body: what `request` says, in the fixed frame's axes, or where it `turns` in the body's
/// own. It is still to be applied.
edit::ApplyLoad checked_force(const std::string& cable, std::int64_t node, RequestedLoad request, const World& world);
edit::ApplyLoad checked_wrench(const std::string& body, bool turns, RequestedLoad request, const World& world);

/// Adds an obstacle, or replaces the one of its name. A frame that is new is where the obstacle says, else as for `pin`.
void set_obstacle(const ObstacleDesc& desc, DrivenWorld& world);
void remove_obstacle(const std::string& name, DrivenWorld& world);

/// Throws SceneError.
void tune(const std::vector<NumberChange>& changes, DrivenWorld& world);

}  // namespace verlet_cable

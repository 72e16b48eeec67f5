#pragma once

#include <vector>

#include "world/state.h"

namespace verlet_cable {

/// Whether a cable exerts moments on bodies that move freely: clamped to one, or welded to a rigid junction. Of `attachments`,
/// those that hold it count: the state's own, or those that are to be there when it starts.
bool turns_bodies(int cable, const std::vector<Attachment>& attachments, const State& state);

}  // namespace verlet_cable

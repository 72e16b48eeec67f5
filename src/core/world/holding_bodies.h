#pragma once

#include <vector>

#include "world/state.h"

namespace verlet_cable {

/// Whether a cable exerts moments on bodies that move freely: clamped to one, or welded to a rigid junction. Of `attachments`,
/// those that hold it count: the state's own, or those that are to be there when it starts.
bool turns_bodies(int cable, const std::vector<Attachment>& attachments, const State& state);

/// Whether clamps at two places twist what is between them. Cables that several sheaves hold count as if they did not: only the
/// law of straight round cables runs over them.
bool is_twisted(int cable, const std::vector<Attachment>& attachments);

}  // namespace verlet_cable

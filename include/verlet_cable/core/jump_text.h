#pragma once

#include <string>

#include "verlet_cable/core/body_name.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/quoted_text.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// Describes a jump, for events.
inline std::string jump_text(const World& world, const Jump& jump) {
  const Attachment& attachment = world.attachments()[static_cast<std::size_t>(jump.attachment)];
  const double milliseconds = 1e3 * jump.duration;
  const std::string duration = milliseconds < 10 ? printed_text(milliseconds, 2) : printed_text(milliseconds, 0, true);
  return "frame " + in_quotes(world.frames()[static_cast<std::size_t>(attachment.frame)]) + " jumped by " +
         printed_text(jump.distance, 2) + " m within " + duration + " ms: " + kind_and_name(world, attachment.body) +
         " was carried along with it";
}

}  // namespace verlet_cable

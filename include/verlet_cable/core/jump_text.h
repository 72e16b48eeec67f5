#pragma once

#include <cstdio>
#include <string>

#include "verlet_cable/core/body_name.h"
#include "verlet_cable/core/quoted_text.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// What a jump did, in words.
inline std::string jump_text(const World& world, const Jump& jump) {
  const Attachment& attachment = world.attachments()[static_cast<std::size_t>(jump.attachment)];
  char measure[64];
  const double milliseconds = 1e3 * jump.duration;
  std::snprintf(measure, sizeof measure,
                milliseconds < 10 ? " jumped by %.2g m within %.2g ms: " : " jumped by %.2g m within %.0f ms: ", jump.distance,
                milliseconds);
  return "frame " + quoted(world.frames()[static_cast<std::size_t>(attachment.frame)]) + measure +
         kind_and_name(world, attachment.body) + " was carried along with it";
}

}  // namespace verlet_cable

#pragma once

#include <string>

#include "verlet_cable/core/load.h"
#include "verlet_cable/core/quoted_text.h"

namespace verlet_cable {

/// What became of a load.
inline std::string ended_load_text(const EndedLoad& load) {
  return "load " + in_quotes(load.name) + " on " + in_quotes(load.on) +
         (load.ran_out ? " has ended: its time has run out" : " has ended: a winch has taken its node in");
}

}  // namespace verlet_cable

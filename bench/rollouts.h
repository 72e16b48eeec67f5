#pragma once

#include <cstdint>
#include <vector>

#include "verlet_cable/core/world.h"

namespace verlet_cable::bench {

/// Copies of a cable that is held by a hand, each with its own motion of the hand, one second long in steps of 5 ms.
struct Rollouts {
  int count = 1000;
  int segments = 100;
  bool bends = false;   ///< clamped and with EI = 0.01 N m^2; else hinged
  bool at_once = true;  ///< by WorldStepper on all cores; else world after world on one
};

/// The world that they are copies of: settled.
World start_of(const Rollouts& rollouts);

struct RolloutResult {
  double seconds = 0;
  std::uint64_t hash = 0;  ///< of the last world at the end
};
RolloutResult run(const Rollouts& rollouts);

}  // namespace verlet_cable::bench

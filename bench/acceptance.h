#pragma once

#include <string>

#include "rope.h"

namespace verlet_cable::bench {

constexpr double infinite = 1e300;

/// What a run must keep to be compared.
struct Criteria {
  double duration = 10;           ///< [s]
  double strain = 0.01;           ///< largest |l / l0 - 1|
  double energy_gain = infinite;  ///< of m g L
  double energy_error = infinite;
  /// Whether the tip must be within 15 mm of -0.785 m at 0.4 s.
  bool tip_height = false;
};

struct Verdict {
  bool accepted = false;
  std::string reason;   ///< why it was not
  double progress = 0;  ///< [s] of simulated time until that was seen
  double strain = 0, energy_gain = 0, energy_error = 0, tip_height = 0;
};

/// Runs until the end or the first breach. `processor_limit` [s]: gives up.
Verdict check(Rope& rope, const RopeTask& task, const Criteria& criteria, double processor_limit);

/// Processor time a simulated second [s], over `duration` [s] of simulated time, or as much as fits `processor_limit` [s].
double processor_time_per_second(Rope& rope, double duration, double processor_limit);

}  // namespace verlet_cable::bench

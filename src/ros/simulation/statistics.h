#pragma once

#include <cstdint>

#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// What happened since the last report.
struct Statistics {
  std::int64_t steps = 0;
  double wall_time = 0;     ///< [s] spent in World::step
  double longest_step = 0;  ///< [s] of wall time
  double max_strain = 0;
  std::int64_t degraded = 0;         ///< steps that were finished less exactly
  std::int64_t exhausted = 0;        ///< of these, those that would have taken too much work
  std::int64_t overstretched = 0;    ///< steps in which held points were too far apart
  std::int64_t jumped = 0;           ///< steps in which a frame was suddenly elsewhere
  std::int64_t inside_obstacle = 0;  ///< steps in which a cable or body was inside an obstacle
  std::int64_t unaccounted = 0;      ///< steps in which energy came from nowhere, or went

  void add(const StepResult& result, const Findings& findings, double step_wall_time);
};

}  // namespace verlet_cable

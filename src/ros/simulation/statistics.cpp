#include "simulation/statistics.h"

#include <algorithm>

namespace verlet_cable {

void Statistics::add(const StepResult& result, const Findings& findings, double step_wall_time) {
  const auto has = [&](StepResult::Status status) {
    const auto is_it = [&](const StatusFinding& found) { return found.status == status; };
    return std::any_of(findings.statuses.begin(), findings.statuses.end(), is_it) ? 1 : 0;
  };
  ++steps;
  wall_time += step_wall_time;
  longest_step = std::max(longest_step, step_wall_time);
  max_strain = std::max(max_strain, result.max_strain);
  degraded += has(StepResult::Status::degraded);
  exhausted += result.exhausted;
  overstretched += has(StepResult::Status::overstretched);
  jumped += has(StepResult::Status::jumped);
  inside_obstacle += has(StepResult::Status::inside_obstacle);
  unaccounted += findings.unaccounted.empty() ? 0 : 1;
}

}  // namespace verlet_cable

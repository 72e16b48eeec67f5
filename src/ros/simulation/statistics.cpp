#include "simulation/statistics.h"

#include <algorithm>

namespace verlet_cable {

void Statistics::add(const StepResult& result, double step_wall_time) {
  ++steps;
  wall_time += step_wall_time;
  longest_step = std::max(longest_step, step_wall_time);
  max_strain = std::max(max_strain, result.max_strain);
  degraded += result.status == StepResult::Status::degraded;
  exhausted += result.exhausted;
  overstretched += result.status == StepResult::Status::overstretched;
  jumped += result.status == StepResult::Status::jumped;
}

}  // namespace verlet_cable

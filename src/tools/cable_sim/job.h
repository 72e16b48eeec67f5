#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "options.h"
#include "verlet_cable/core/scene_desc.h"
#include "verlet_cable/scene/loads.h"
#include "verlet_cable/scene/motion.h"

namespace verlet_cable::cable_sim {

/// When rows are due, counted in steps so that rounding cannot shift them: row k at the first step at or after k / rate.
class RowSchedule {
 public:
  RowSchedule(double rate, double time_step) : steps_a_row_(1 / (rate * time_step)) {}

  std::int64_t step_of(std::int64_t row) const;

 private:
  double steps_a_row_;
};

/// How many steps reach a duration; rounding does not add one.
std::int64_t steps_for(double duration, double time_step);

/// What is to be simulated, checked.
struct Job {
  SceneDesc scene;
  Motion motion;
  Loads loads;
  bool settle = false;  ///< into equilibrium before t = 0
  std::int64_t steps = 0;
  double rate = 0;        ///< [Hz] of rows
  std::int64_t rows = 0;  ///< of the output a node
};

/// Reads and checks everything that the options name, without writing anything. Adds a line to `errors` for all that is wrong.
Job prepare(const Options& options, std::vector<std::string>& errors);

}  // namespace verlet_cable::cable_sim

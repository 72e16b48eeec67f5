#pragma once

#include <cstdint>

namespace verlet_cable {

/// How far a step of an island has come.
struct StepProgress {
  std::int64_t done = 0;  ///< parts of the step, of the shortest substep
  int level = 0;          ///< substeps are a step halved so often
  int substeps = 0;
  double work = 0;       ///< see `budget`
  bool stopped = false;  ///< it was brought to rest
};

/// A substep, in parts of the step.
struct PartOfStep {
  std::int64_t first = 0, last = 0, whole = 1;
  double from() const { return static_cast<double>(first) / static_cast<double>(whole); }
  double to() const { return static_cast<double>(last) / static_cast<double>(whole); }
};

}  // namespace verlet_cable

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

/// Who waits for a step does not wait longer than a budget of work. It counts visits of a segment by an iteration that solves
/// nothing but tension and bending, each about 50 ns, and no time: the same on every machine.
namespace budget {
/// Of all islands together that the first share was not enough for, by their sizes.
constexpr double most = 5e5;
/// Of every island: iterations, of its size. Few steps take more.
constexpr double first_share = 40;
constexpr double heavy = 6;     ///< times as long take twist, contacts and bodies
constexpr double coupling = 2;  ///< likewise, a step that couples cables which touch each other
constexpr double guide = 0.3;   ///< so much longer takes each guide, whose flow all of a cable responds to
constexpr double cable = 4;     ///< counts as so many segments, beside those that it has
constexpr double body = 100;    ///< likewise
}  // namespace budget

}  // namespace verlet_cable

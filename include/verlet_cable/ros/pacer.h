#pragma once

#include <optional>

#include "verlet_cable/ros/time_grid.h"

namespace verlet_cable {

/// Decides which time the next step leads to, and counts the time that is never simulated. Knows no clock.
///
/// Steps that are late are caught up. Where they cannot be, time is left out evenly: a step leads further than it is long, at a
/// pace that changes gently, so that frames which move smoothly still do and cables are not whipped by the hiccups of a machine.
class Pacer {
 public:
  /// `longest_backlog`: what is further behind than this is not caught up.
  Pacer(const TimeGrid& grid, Nanoseconds longest_backlog);

  void use(const TimeGrid& grid, Nanoseconds longest_backlog);  ///< from now on

  /// Where to go on from, to be asked before steps are done: later than `simulated` where `target`, the time to be at, has leapt
  /// so far since the last call that it cannot be caught up.
  Nanoseconds resume(Nanoseconds simulated, Nanoseconds target);
  /// The time that the next step leads to: on the grid while nothing is left out; none where it is not due.
  std::optional<Nanoseconds> next(Nanoseconds simulated, Nanoseconds target) const;
  /// The step from `simulated` to `time` was done.
  void done(Nanoseconds simulated, Nanoseconds time, Nanoseconds target);

  /// Counts time that is skipped for another reason, such as a pause.
  void drop(Nanoseconds skipped);
  Nanoseconds dropped() const { return dropped_; }  ///< in all

 private:
  TimeGrid grid_;
  Nanoseconds longest_backlog_;
  Nanoseconds last_target_ = 0;
  Nanoseconds dropped_ = 0;
  double pace_ = 1;  ///< how far a step leads, in steps
};

}  // namespace verlet_cable

#pragma once

#include "verlet_cable/ros/time_grid.h"

namespace verlet_cable {

/// Decides how many fixed steps are due, and counts the time that is never simulated. Knows no clock.
class Pacer {
 public:
  /// `step`: of the simulation; `longest_backlog`: what is further behind than this is dropped, not caught up.
  Pacer(Nanoseconds step, Nanoseconds longest_backlog);

  void use(Nanoseconds step, Nanoseconds longest_backlog);  ///< from now on

  struct Due {
    Nanoseconds dropped = 0;  ///< to be skipped before stepping, a multiple of the step
    Nanoseconds steps = 0;    ///< to be done then, to come as close to the target as whole steps do without passing it
  };
  /// What lies between the simulated time and the time it should be at. Nothing where the target is not ahead.
  Due due(Nanoseconds simulated, Nanoseconds target);

  /// Counts time that is skipped for another reason, such as a pause.
  void drop(Nanoseconds skipped);
  /// Counts time that was to be skipped, and was not after all.
  void take_back(Nanoseconds skipped) { dropped_ -= skipped; }
  Nanoseconds dropped() const { return dropped_; }  ///< in all

 private:
  Nanoseconds step_;
  Nanoseconds longest_backlog_;
  Nanoseconds dropped_ = 0;
};

}  // namespace verlet_cable

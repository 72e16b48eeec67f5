#pragma once

#include <optional>

#include "time/time_grid.h"

namespace verlet_cable {

/// Decides which time the next step leads to, and counts the time that is never simulated. Knows no clock.
///
/// Steps that are late are caught up. Where they cannot be, time is left out evenly: a step leads further than it is long, at a
/// pace that changes gently, so that frames which move smoothly still do and cables are not whipped by the hiccups of a machine.
/// What a machine cannot do for good is not caught up: after some seconds it is only a little late.
class Pacer {
 public:
  /// `longest_backlog`: what is further behind than this is not caught up.
  Pacer(const TimeGrid& grid, Nanoseconds longest_backlog);

  void use(const TimeGrid& grid, Nanoseconds longest_backlog);  ///< from now on

  /// Where to go on from, to be asked before steps are done: later than `simulated` where `target`, the time to be at, is further
  /// ahead than the longest backlog.
  Nanoseconds resume(Nanoseconds simulated, Nanoseconds target);
  /// The time that the next step leads to: on the grid while nothing is left out; none where it is not due.
  std::optional<Nanoseconds> next(Nanoseconds simulated, Nanoseconds target) const;
  /// The step from `simulated` to `time` was done.
  void done(Nanoseconds simulated, Nanoseconds time, Nanoseconds target);

  /// Nothing is late for want of time: what is due is done, or waits for something else.
  void rest();

  /// Counts time that is skipped for another reason, such as a pause.
  void drop(Nanoseconds skipped);
  Nanoseconds dropped() const { return dropped_; }    ///< in all
  Nanoseconds left_out() const { return left_out_; }  ///< of that, because the machine was too slow

 private:
  TimeGrid grid_;
  Nanoseconds longest_backlog_;
  Nanoseconds last_target_ = 0;
  Nanoseconds dropped_ = 0;
  Nanoseconds left_out_ = 0;
  double pace_ = 1;                        ///< how far a step leads, in steps
  double usual_way_ = 0;                   ///< [s] of a step, a mean of the last ones
  double busy_ = 0;                        ///< [s] of the target's time since all that was due was done
  double busy_time_ = 0, busy_steps_ = 0;  ///< likewise, and how many steps; what is long ago counts less
  Nanoseconds done_target_ = 0;            ///< at the last step
};

}  // namespace verlet_cable

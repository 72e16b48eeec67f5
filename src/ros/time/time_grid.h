#pragma once

#include <cstdint>

namespace verlet_cable {

/// ROS time as a whole number [ns], so that adding steps never rounds.
using Nanoseconds = std::int64_t;

Nanoseconds nanoseconds(double seconds);
double seconds(Nanoseconds time);

/// The instants that the node simulates: multiples of the time step in ROS time, whatever the moment the node was started, so
/// that the same frames give the same run. Ticks, which are published, are the first steps at or after the multiples of the
/// publish period.
class TimeGrid {
 public:
  /// `time_step` [s] and `publish_rate` [Hz]: > 0.
  TimeGrid(double time_step, double publish_rate);

  Nanoseconds step() const { return step_; }
  Nanoseconds period() const { return period_; }  ///< of the ticks

  Nanoseconds step_at_or_before(Nanoseconds time) const;
  Nanoseconds step_at_or_after(Nanoseconds time) const;
  Nanoseconds tick_at_or_after(Nanoseconds time) const;
  bool is_tick(Nanoseconds step_time) const;
  /// Whether a tick lies after `from` and not after `to`.
  bool passes_tick(Nanoseconds from, Nanoseconds to) const;

 private:
  Nanoseconds step_;
  Nanoseconds period_;
};

}  // namespace verlet_cable

#include "time/time_grid.h"

#include <algorithm>
#include <cmath>

namespace verlet_cable {
namespace {

Nanoseconds floor_multiple(Nanoseconds time, Nanoseconds unit) {
  const Nanoseconds remainder = time % unit;
  return time - (remainder < 0 ? remainder + unit : remainder);
}

Nanoseconds ceil_multiple(Nanoseconds time, Nanoseconds unit) {
  return -floor_multiple(-time, unit);
}

}  // namespace

Nanoseconds nanoseconds(double seconds) {
  // Beyond any ROS time, and small enough that the sum of two does not overflow.
  constexpr double limit = 4e18;
  return std::llround(std::clamp(seconds * 1e9, -limit, limit));
}

double seconds(Nanoseconds time) {
  return static_cast<double>(time) * 1e-9;
}

TimeGrid::TimeGrid(double time_step, double publish_rate)
    : step_(std::max<Nanoseconds>(nanoseconds(time_step), 1)), period_(std::max<Nanoseconds>(nanoseconds(1 / publish_rate), 1)) {}

Nanoseconds TimeGrid::step_at_or_before(Nanoseconds time) const {
  return floor_multiple(time, step_);
}

Nanoseconds TimeGrid::step_at_or_after(Nanoseconds time) const {
  return ceil_multiple(time, step_);
}

Nanoseconds TimeGrid::tick_at_or_after(Nanoseconds time) const {
  // The period before `time` may have its step after it.
  const Nanoseconds earlier = step_at_or_after(floor_multiple(time, period_));
  return earlier >= time ? earlier : step_at_or_after(ceil_multiple(time, period_));
}

bool TimeGrid::is_tick(Nanoseconds step_time) const {
  return passes_tick(step_time - step_, step_time);
}

bool TimeGrid::passes_tick(Nanoseconds from, Nanoseconds to) const {
  return floor_multiple(to, period_) > from;
}

}  // namespace verlet_cable

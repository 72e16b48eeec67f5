#include "verlet_cable/ros/pacer.h"

#include <algorithm>
#include <cmath>

namespace verlet_cable {
namespace {

/// A target that is further ahead [s] than can be caught up has leapt.
constexpr double leap = 0.2;
/// Beyond the longest backlog the pace grows by a factor of e each time the backlog grows by this [s]: whatever the load, there
/// is a pace that keeps up.
constexpr double backlog_scale = 0.5;
/// In which the pace follows the backlog [s].
constexpr double pace_lag = 0.1;
/// From here on down nothing is left out.
constexpr double least_pace = 1.001;

}  // namespace

Pacer::Pacer(const TimeGrid& grid, Nanoseconds longest_backlog) : grid_(grid), longest_backlog_(longest_backlog) {}

void Pacer::use(const TimeGrid& grid, Nanoseconds longest_backlog) {
  grid_ = grid;
  longest_backlog_ = longest_backlog;
}

Nanoseconds Pacer::resume(Nanoseconds simulated, Nanoseconds target) {
  const Nanoseconds leapt = target - std::max(last_target_, simulated + longest_backlog_);
  last_target_ = target;
  if (leapt <= nanoseconds(leap)) return simulated;
  const Nanoseconds time = grid_.step_at_or_after(simulated + leapt);
  drop(time - simulated);
  return time;
}

std::optional<Nanoseconds> Pacer::next(Nanoseconds simulated, Nanoseconds target) const {
  const Nanoseconds step = grid_.step();
  const Nanoseconds time =
      pace_ > 1 ? simulated + std::llround(pace_ * static_cast<double>(step)) : grid_.step_at_or_after(simulated + step);
  return time <= target ? std::optional(time) : std::nullopt;
}

void Pacer::done(Nanoseconds simulated, Nanoseconds time, Nanoseconds target) {
  drop(time - simulated - grid_.step());
  const double beyond = std::max(seconds(target - time - longest_backlog_), 0.0);
  const double followed = std::min(seconds(time - simulated) / pace_lag, 1.0);
  pace_ += followed * (std::exp(beyond / backlog_scale) - pace_);
  if (beyond == 0 && pace_ < least_pace) pace_ = 1;
}

void Pacer::drop(Nanoseconds skipped) {
  dropped_ += std::max<Nanoseconds>(skipped, 0);
}

}  // namespace verlet_cable

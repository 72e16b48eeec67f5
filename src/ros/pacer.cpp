#include "verlet_cable/ros/pacer.h"

#include <algorithm>
#include <cmath>

namespace verlet_cable {
namespace {

/// A target that is further ahead [s] than can be caught up has leapt.
constexpr double leap = 0.2;
/// Further behind [s], beyond the longest backlog, no pace leads anywhere.
constexpr double most_beyond = 5;
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
  const Nanoseconds beyond = target - simulated - longest_backlog_, leapt = std::min(beyond, target - last_target_);
  last_target_ = target;
  Nanoseconds skipped = leapt > nanoseconds(leap) ? leapt : 0;
  if (beyond - skipped > nanoseconds(most_beyond)) skipped = beyond;
  if (skipped == 0) return simulated;
  const Nanoseconds time = grid_.step_at_or_after(simulated + skipped);
  drop(time - simulated);
  return time;
}

std::optional<Nanoseconds> Pacer::next(Nanoseconds simulated, Nanoseconds target) const {
  const Nanoseconds step = grid_.step();
  // After a pause the pace may still be that of before: a step does not wait for what is not there to be left out.
  const Nanoseconds longest = step + (target - simulated) / 4;
  const Nanoseconds way = std::min<Nanoseconds>(std::llround(pace_ * static_cast<double>(step)), longest);
  const Nanoseconds time = pace_ > 1 ? simulated + way : grid_.step_at_or_after(simulated + step);
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

#include "time/pacer.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace verlet_cable {
namespace {

/// Of the target's time, between two calls [s], that counts as busy: in a leap nobody was.
constexpr double longest_busy = 0.2;
/// Beyond the backlog that is caught up the pace grows by a factor of e each time the backlog grows by this [s]: whatever the
/// load, there is a pace that keeps up. The smaller one is for a lasting overload, with steps that take no time.
constexpr double longest_scale = 0.5, shortest_scale = 0.1;
/// A machine that has not caught up for so long [s] will not: from then on less and less is left to catch up, by a factor of e in
/// each `surrender` [s], down to `shortest_backlog` [s].
constexpr double catching_up = 2, surrender = 0.5, shortest_backlog = 0.09;
/// Over which the mean way of a step is taken [s].
constexpr double way_memory = 2;
/// Of what the machine needed for the last 25 steps or so, from step to step.
constexpr double kept = 1 - 1.0 / 25;
/// In mean ways of a step: what a lasting overload leaves of both, so that a step that takes longer than others changes the pace
/// little.
constexpr double steps_of_scale = 8, steps_of_backlog = 6;
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
  const Nanoseconds beyond = target - simulated - longest_backlog_;
  const bool leapt = target - last_target_ > nanoseconds(longest_busy);
  if (target - simulated > grid_.step()) busy_ += std::clamp(seconds(target - last_target_), 0.0, longest_busy);
  last_target_ = target;
  if (beyond <= 0) return simulated;
  const Nanoseconds time = grid_.step_at_or_after(simulated + beyond);
  if (!leapt || busy_ > catching_up) left_out_ += time - simulated;
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
  left_out_ += std::max<Nanoseconds>(time - simulated - grid_.step(), 0);
  const double way = seconds(time - simulated), longest = seconds(longest_backlog_);
  usual_way_ += std::min(way / way_memory, 1.0) * (way - usual_way_);
  const double given_up = std::exp(-std::max(busy_ - catching_up, 0.0) / surrender);
  const double backlog =
      std::max(given_up * longest, std::min(std::max(shortest_backlog, steps_of_backlog * usual_way_), longest));
  const double scale = std::max(given_up * longest_scale, std::clamp(steps_of_scale * usual_way_, shortest_scale, longest_scale));
  // What the machine needs for a step, once it is not expected to catch up, whatever the backlog is.
  busy_time_ = kept * busy_time_ + seconds(std::max<Nanoseconds>(target - done_target_, 0));
  busy_steps_ = kept * busy_steps_ + 1;
  done_target_ = target;
  const double needed = std::max(busy_time_ / (busy_steps_ * seconds(grid_.step())), 1.0);
  const double behind = seconds(target - time), part = std::clamp(2 * behind / backlog, 0.0, 1.0);
  const double wanted = std::pow(needed, (1 - given_up) * part) * std::exp(std::max(behind - backlog, 0.0) / scale);
  pace_ += std::min(way / pace_lag, 1.0) * (wanted - pace_);
  if (wanted == 1 && pace_ < least_pace) pace_ = 1;
  if (target - time < grid_.step()) rest();
}

void Pacer::rest() {
  busy_ = busy_time_ = busy_steps_ = 0;
}

void Pacer::drop(Nanoseconds skipped) {
  // A clock that leaps to and fro by decades adds up to more than there are numbers for.
  dropped_ += std::clamp<Nanoseconds>(skipped, 0, std::numeric_limits<Nanoseconds>::max() - dropped_);
}

}  // namespace verlet_cable

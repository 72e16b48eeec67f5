#include "time/overload_watch.h"

#include <utility>

namespace verlet_cable {
namespace {

constexpr double first_window = 2, window = 10;  // [s] of wall time
/// A smaller part of the time is a hiccup.
constexpr double least_part = 0.02;

}  // namespace

std::optional<OverloadWatch::Report> OverloadWatch::look(Nanoseconds target, Nanoseconds left_out, double wall) {
  if (wall - wall_ < (overloaded_ ? window : first_window) && wall >= wall_) return std::nullopt;
  const double passed = seconds(target - std::exchange(target_, target));
  const double dropped = seconds(left_out - std::exchange(left_out_, left_out));
  wall_ = wall;
  overloaded_ = passed > 0 && dropped > least_part * passed && dropped < passed;
  return overloaded_ ? std::optional(Report{1 - dropped / passed, dropped}) : std::nullopt;
}

}  // namespace verlet_cable

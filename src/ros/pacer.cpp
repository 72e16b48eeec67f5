#include "verlet_cable/ros/pacer.h"

#include <algorithm>

namespace verlet_cable {

Pacer::Pacer(Nanoseconds step, Nanoseconds longest_backlog) : step_(step), longest_backlog_(std::max(longest_backlog, step)) {}

void Pacer::use(Nanoseconds step, Nanoseconds longest_backlog) {
  step_ = step;
  longest_backlog_ = std::max(longest_backlog, step);
}

Pacer::Due Pacer::due(Nanoseconds simulated, Nanoseconds target) {
  const Nanoseconds behind = std::max<Nanoseconds>(target - simulated, 0);
  const Nanoseconds steps_behind = behind / step_;
  const Nanoseconds steps = std::min(steps_behind, longest_backlog_ / step_);
  const Due due{(steps_behind - steps) * step_, steps};
  drop(due.dropped);
  return due;
}

void Pacer::drop(Nanoseconds skipped) {
  dropped_ += std::max<Nanoseconds>(skipped, 0);
}

}  // namespace verlet_cable

#include <cmath>

#include "net/constraint_solver.h"
#include "target/kinematic_targets.h"

namespace verlet_cable {

namespace {

/// What turns too far even in so many parts of a step is left to the corrections along the directions at the end.
constexpr int most_parts = 16;

}  // namespace

/// Where there is no work left for smaller parts, what the larger ones came to is the best there is.
NetStepResult NetConstraintSolver::advance(const NetStep& step, NetState& state, LinkMemory& memory) {
  state_before_ = state;
  memory_before_ = memory;
  work_ = 0;
  exhausted_ = false;
  NetStepResult result = advance_in_parts(1, step, state, memory);
  for (int parts = 2; parts <= most_parts && turned_ && result.overstretched_node < 0 && !exhausted_; parts *= 2) {
    exhausted_ = work_ + work_of_parts(step.model, parts) > most_work_;
    if (exhausted_) break;
    const int iterations = result.iterations;
    coarser_ = {state, memory, result, step.held};
    state = state_before_;
    memory = memory_before_;
    result = advance_in_parts(parts, step, state, memory);
    const int tried = result.iterations;
    if (exhausted_) {
      std::swap(state, coarser_.state);
      std::swap(memory, coarser_.memory);
      std::swap(result, coarser_.result);
      step.held = coarser_.held;
    }
    result.iterations = iterations + tried;
  }
  result.exhausted = exhausted_;
  return result;
}

/// Stops where it is of no use to go on.
NetStepResult NetConstraintSolver::advance_in_parts(int parts, const NetStep& step, NetState& state, LinkMemory& memory) {
  parts_ = parts;
  h_ = step.h() / parts;
  NetStepResult result;
  if (parts == 1) {
    part_ = 0;
    advance_part(step, state, memory, result);
    return result;
  }
  for (HeldNode& held : step.held) held.force.setZero();
  for (part_ = 0; part_ < parts; ++part_) {
    hold_at(0, static_cast<double>(part_ + 1) / parts, step.targets, boundary_);
    const NetStep part{step.model, step.scene, step.obstacles, step.targets, boundary_.nodes};
    advance_part(part, state, memory, result);
    for (std::size_t k = 0; k < step.held.size(); ++k) step.held[k].force += boundary_.nodes[k].force / parts;
    if (!result.finite || result.torn || exhausted_ || (turned_ && parts < most_parts)) break;
  }
  return result;
}

}  // namespace verlet_cable

#include "target/jump.h"

#include <algorithm>

namespace verlet_cable {

namespace {

/// A change of velocity that lasts longer [s] is no jump.
constexpr double longest_jump = 5e-3;
/// A change of velocity that is not greater than the one before by this fraction goes on with an acceleration.
constexpr double sudden = 0.5;
/// In steps longer than a jump all changes are great: one that is so many times greater than those before is no motion.
constexpr double out_of_proportion = 3;
constexpr double fading = 0.5;  // of what went before, in a step
/// Below this change [m/s] in a step a velocity is a motion's; above it may be noise, and the average over some time [s] is
/// better.
constexpr double steady_change = 1;
constexpr double averaging_time = 0.02;
/// A jump at one speed may begin and end inside steps: up to this fraction it is one speed.
constexpr double one_speed = 0.1;
/// What might have been a jump and was a motion, as it lasted, ends without one if it does within this time [s].
constexpr double shortly = 0.02;
constexpr double rounding_of_jump = 1e-6;

/// Whether a jump may begin in a step with this mean velocity, and its velocity before. An acceleration that goes on is none, nor
/// is what comes back from a change that was no jump.
bool may_begin_jump(const Vector3& mean, double time_step, double jump_speed, KinematicTarget& target) {
  const Vector3 change = mean - target.mean_velocity;
  if (!(change.norm() > jump_speed)) return false;
  if (target.left_for < shortly && !((mean - target.left_velocity).norm() > jump_speed)) return false;
  const double jerk = (change - target.change).norm();
  if (jerk <= jump_speed || jerk <= sudden * target.change.norm()) return false;
  if (time_step > longest_jump * (1 + rounding_of_jump) && change.norm() <= out_of_proportion * target.liveliness) return false;
  const Vector3 before = target.change.norm() <= steady_change ? target.mean_velocity : target.average_velocity;
  if (!((mean - before).norm() > jump_speed)) return false;
  target.mean_velocity = before;
  return true;
}

/// Whether what has gone on for some steps, and goes on with this excess of velocity, may be a jump. Where it does not fit into
/// the longest time with its whole first and last step, it does with parts of them if it has one speed.
bool is_short(double excess, double time_step, const KinematicTarget& target) {
  const int steps = target.jumping_steps + 1;
  const double longest = longest_jump / time_step * (1 + rounding_of_jump);
  // Two steps may both be parts: how long it lasted in them cannot be told.
  if (steps <= std::max(longest, 2.0)) return true;
  const double least = target.jumping_steps > 2 ? std::min(target.least_excess, target.last_excess) : target.last_excess;
  const double greatest = std::max(target.greatest_excess, target.last_excess);
  return greatest - least <= one_speed * greatest && steps - 2 + (target.first_excess + excess) / greatest <= longest;
}

void begin_or_continue_jump(double excess, KinematicTarget& target) {
  if (target.jumping_steps == 0) {
    target.jumped_from = target.position;
    target.first_excess = excess;
  } else if (target.jumping_steps > 1) {
    target.least_excess = target.jumping_steps == 2 ? target.last_excess : std::min(target.least_excess, target.last_excess);
    target.greatest_excess = std::max(target.greatest_excess, target.last_excess);
  }
  target.last_excess = excess;
  ++target.jumping_steps;
}

}  // namespace

void end_jump(KinematicTarget& target) {
  target.jumping_steps = 0;
  target.jumped_from = target.carried = Vector3::Zero();
  target.first_excess = target.last_excess = target.least_excess = target.greatest_excess = 0;
}

Change judge(const Vector3& mean, double time_step, double jump_speed, KinematicTarget& target) {
  if (target.jumping_steps == 0 && !may_begin_jump(mean, time_step, jump_speed, target)) return Change::none;
  const double excess = (mean - target.mean_velocity).norm();
  if (excess <= jump_speed) return Change::jump;
  if (is_short(excess, time_step, target)) {
    begin_or_continue_jump(excess, target);
    return Change::undecided;
  }
  const Vector3 lasting = (target.next_position - target.jumped_from) / ((target.jumping_steps + 1) * time_step);
  if ((lasting - target.mean_velocity).norm() > jump_speed) {
    target.left_velocity = target.mean_velocity;
    target.left_for = 0;
    return Change::motion;
  }
  end_jump(target);
  target.mean_velocity = lasting;
  if (!((mean - lasting).norm() > jump_speed)) return Change::none;
  begin_or_continue_jump((mean - lasting).norm(), target);
  return Change::undecided;
}

void note_motion(const Vector3& change, const Vector3& mean, double time_step, KinematicTarget& target) {
  target.change = change;
  target.left_for += time_step;
  target.liveliness = std::max(fading * target.liveliness, change.norm());
  target.average_velocity += time_step / (averaging_time + time_step) * (mean - target.average_velocity);
}

}  // namespace verlet_cable

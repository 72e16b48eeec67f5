#include "frame_speed.h"

#include <algorithm>

namespace verlet_cable {
namespace {

/// A frame that moves at just the allowed speed is not held back because of rounding.
constexpr double rounding = 1e-9;

}  // namespace

bool limit_motion(const Pose& from, double distance, Pose& to) {
  const Vector3 way = to.position - from.position;
  if (way.norm() <= distance * (1 + rounding)) return false;
  const double fraction = distance / way.norm();
  to = {from.position + fraction * way, from.orientation.slerp(fraction, to.orientation).normalized()};
  return true;
}

std::vector<int> limit_frame_motion(const BoundaryInputs& before, double distance, BoundaryInputs& frames) {
  std::vector<int> held_back;
  for (std::size_t i = 0; i < std::min(before.size(), frames.size()); ++i) {
    const bool both_known = before[i].known && frames[i].known;
    if (both_known && limit_motion(before[i].pose, distance, frames[i].pose)) held_back.push_back(static_cast<int>(i));
  }
  return held_back;
}

void limit_frame_velocities(double speed, BoundaryInputs& frames) {
  for (FrameInput& frame : frames) {
    if (!frame.velocity || frame.velocity->linear.norm() <= speed) continue;
    const double fraction = speed / frame.velocity->linear.norm();
    frame.velocity->linear *= fraction;
    frame.velocity->angular *= fraction;
  }
}

}  // namespace verlet_cable

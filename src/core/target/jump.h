#pragma once

#include "target/kinematic_targets.h"

namespace verlet_cable {

/// What a change of velocity turns out to be.
enum class Change { none, undecided, jump, motion };

/// The change in a step with this mean velocity [m/s]. One by more than `jump_speed` [m/s] that lasts longer than 5 ms is a
/// motion, and to be followed; until that is known it may be a jump. What trembles goes as its mean does.
Change judge(const Vector3& mean, double time_step, double jump_speed, KinematicTarget& target);

/// Keeps in mind how a target moves in a step.
void note_motion(const Vector3& change, const Vector3& mean, double time_step, KinematicTarget& target);

/// A jump is over.
void end_jump(KinematicTarget& target);

}  // namespace verlet_cable

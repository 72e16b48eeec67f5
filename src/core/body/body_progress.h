#pragma once

#include <vector>

#include "contact/cache.h"
#include "target/kinematic_targets.h"

namespace verlet_cable {

/// What the next substep goes on from at an attachment of a body; on the body that is held, the torque about the attachment's
/// point.
struct JointProgress {
  int attachment = 0;                                         ///< index into World::attachments()
  Vector3 force = Vector3::Zero(), torque = Vector3::Zero();  ///< [N], [N m] its multipliers
  /// [N], [N m] what accelerations come of, see mean_force
  Vector3 lasting_force = Vector3::Zero(), lasting_torque = Vector3::Zero();
};

/// What decides a rigid body's future besides the state that it shows.
struct BodyProgress {
  /// It is where it begins: what holds it is known, or a cable whose end it is has started. Until then nothing hangs on it.
  bool is_placed = false;
  bool has_moved = false;  ///< its velocity is one that what holds it, and what it holds, allows
  /// [m/s^2] of its center of mass together with the nodes that it holds, and [rad/s^2] in its frame's axes, mean over the last
  /// substep: where the next one's solution starts, and what substeps that damp go on from
  Vector3 acceleration = Vector3::Zero(), angular_acceleration = Vector3::Zero();
  std::vector<KinematicTarget> holders;  ///< frames that hold it, by its attachments; `node` counts them
  ContactCache contacts;                 ///< with obstacles
  std::vector<Vector3> holder_spins;     ///< [rad/s] of each, mean over the last step; while it jumps, of the motion before
  std::vector<JointProgress> joints;     ///< what holds it, frames and bodies, as far as a substep has found that
  double energy = 0;                     ///< [J] as the ledger has it
};

}  // namespace verlet_cable

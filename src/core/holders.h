#pragma once

#include <vector>

#include "held_node.h"
#include "verlet_cable/core/cable.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// The motion of one held node of a cable over a step.
struct Holder {
  int attachment = 0;  ///< index into World::attachments()
  int node = 0;
  Vector3 position = Vector3::Zero();       ///< [m] at the world's time
  Vector3 velocity = Vector3::Zero();       ///< [m/s] at the world's time
  Vector3 mean_velocity = Vector3::Zero();  ///< [m/s] over the last step
  Vector3 gap = Vector3::Zero();            ///< [m] from its place to where it was when it was caught; closed smoothly
  double caught = -infinity;                ///< [s] when that was
  Vector3 next_position = Vector3::Zero();  ///< [m] at the end of the step
  Vector3 next_velocity = Vector3::Zero();  ///< [m/s]
};

/// The motion of a direction and roll that a clamp holds, over a step.
struct DirectionHolder {
  int attachment = 0;
  int node = 0;
  Quaternion orientation = Quaternion::Identity();       ///< at the world's time
  Quaternion gap = Quaternion::Identity();               ///< from its place to where it was when it was caught; closed smoothly
  double caught = -infinity;                             ///< [s] when that was
  Quaternion next_orientation = Quaternion::Identity();  ///< at the end of the step
};

/// What holds a cable; both ascending by node.
struct Holders {
  std::vector<Holder> nodes;
  std::vector<DirectionHolder> directions;
};

/// Where an attachment wants nodes to be: its own, and for a clamp of a cable without bending stiffness the neighbours, too, so
/// that the direction is held.
struct Target {
  int node = 0;
  Vector3 position = Vector3::Zero();
};
std::vector<Target> attachment_targets(const CableModel& model, const Attachment& attachment, const Pose& frame);

/// The holders of a cable, ascending by node; a node that two attachments want belongs to the one that is attached to it.
/// Those that `before` has keep their motion; others catch their node where it is at `time`.
Holders find_holders(int cable, const CableModel& model, const CableState& state, const std::vector<Attachment>& attachments,
                     const std::vector<Pose>& frames, const Holders& before, double time);

/// The holders of a net likewise: hinges.
Holders find_net_holders(int net, const std::vector<Vector3>& positions, const std::vector<Vector3>& velocities,
                         const std::vector<Attachment>& attachments, const std::vector<Pose>& frames, const Holders& before,
                         double time);

/// Sets where the holders will be at the end of a step that ends at `time`, `frames` being the poses then. False if one of them
/// would have to jump.
bool aim_holders(const CableModel& model, const std::vector<Attachment>& attachments, const std::vector<Pose>& frames,
                 double time, double time_step, Holders& holders);

/// The same for hinges.
bool aim_hinges(const std::vector<Attachment>& attachments, const std::vector<Pose>& frames, double time, double time_step,
                Holders& holders);

/// Puts the holders where they aim, at rest.
void jump_to_aim(Holders& holders);

/// What is held at the end of a substep that goes from one part of the step to another, 0 to 1.
void hold_at(double from, double to, const Holders& holders, Boundary& boundary);

/// The step is done: what was next is now.
void complete_step(double time_step, Holders& holders);

}  // namespace verlet_cable

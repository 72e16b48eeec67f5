#pragma once

#include <algorithm>
#include <vector>

#include "target/boundary.h"
#include "verlet_cable/core/cable.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// The motion of one held node of a cable over a step.
struct KinematicTarget {
  int attachment = 0;  ///< index into World::attachments()
  int node = 0;
  Vector3 position = Vector3::Zero();       ///< [m] at the world's time
  Vector3 velocity = Vector3::Zero();       ///< [m/s] at the world's time
  Vector3 mean_velocity = Vector3::Zero();  ///< [m/s] over the last step; while it jumps, of the motion before
  bool starts = false;                      ///< its velocity is not known before its first step is
  /// [m] from its place to where it was when it was caught, in the axes of the body that holds it if one does; closed smoothly
  Vector3 gap = Vector3::Zero();
  double caught = -infinity;                ///< [s] when that was
  Vector3 next_position = Vector3::Zero();  ///< [m] at the end of the step
  Vector3 next_velocity = Vector3::Zero();  ///< [m/s]
  // What tells a jump from a motion.
  Vector3 frame_velocity = Vector3::Zero();    ///< [m/s] over the last step, also while it jumps
  Vector3 average_velocity = Vector3::Zero();  ///< [m/s] of the last 20 ms or so, without jumps
  Vector3 change = Vector3::Zero();            ///< [m/s] of the velocity from step to step, the last one
  Vector3 left_velocity = Vector3::Zero();     ///< [m/s] before the last motion that might have been a jump
  double left_for = infinity;                  ///< [s] since that was known to be a motion
  double liveliness = 0;                       ///< [m/s] the greatest change of late
  // Of a jump: a change of velocity that is too great for a motion, as long as it is not known to last.
  int jumping_steps = 0;                  ///< in which it has lasted; 0: there is none
  Vector3 jumped_from = Vector3::Zero();  ///< [m] where the holder was then
  Vector3 carried = Vector3::Zero();      ///< [m] how far it has carried the cable
  double first_excess = 0;                ///< [m/s] over the velocity before, in the first step
  double last_excess = 0;                 ///< [m/s] in the last one
  double least_excess = 0;                ///< [m/s] of those between
  double greatest_excess = 0;             ///< [m/s] of those between
  bool slides = false;                    ///< whether the cable's material flows through it
  /// [N] as HeldNode has it
  Vector3 lasting_force = Vector3::Zero();
};

/// Whether a node that was caught is still on its way to where its holder has it, at a time [s].
bool is_drawn_to_holder(const KinematicTarget& target, double time);

/// The motion of a direction and roll that a clamp holds, over a step.
struct DirectionTarget {
  int attachment = 0;
  int node = 0;
  Quaternion orientation = Quaternion::Identity();       ///< at the world's time
  Quaternion gap = Quaternion::Identity();               ///< from its place to where it was when it was caught; closed smoothly
  double caught = -infinity;                             ///< [s] when that was
  Quaternion next_orientation = Quaternion::Identity();  ///< at the end of the step
  /// [rad] of a whole rod, about the clamp's direction: how the material is turned against the attachment
  double roll = 0;
  /// [rad] of a whole rod that is clamped inside, any number of turns: between the segment before and the clamp, and between the
  /// clamp and the segment after it
  double twist_before = 0, twist_after = 0;
  /// [N m] as HeldDirection has it
  Vector3 lasting_torque = Vector3::Zero();
};

/// What holds a cable; both ascending by node.
struct KinematicTargets {
  std::vector<KinematicTarget> nodes;
  std::vector<DirectionTarget> directions;
};

/// Whether the cable resists bending on a side of a node.
bool bends_at(const CableModel& model, const CableState& state, int node);

/// Where an attachment wants nodes to be: its own, and for a clamp of a cable without bending stiffness the neighbours, too, so
/// that the direction is held.
struct WantedNode {
  int node = 0;
  Vector3 position = Vector3::Zero();
};
std::vector<WantedNode> wanted_nodes(const CableModel& model, const CableState& state, const Attachment& attachment,
                                     const Pose& frame);

/// Indices of the attachments of a cable's or net's nodes, ascending.
std::vector<int> attachments_of(const BodyId& body, const std::vector<Attachment>& attachments);

/// The holders of a cable whose attachments are `own`, ascending by node; a node that two attachments want belongs to the one
/// that is attached to it. Those that `before` has keep their motion; others catch their node where it is at `time`.
KinematicTargets find_targets(const CableModel& model, const CableState& state, const std::vector<Attachment>& attachments,
                              const std::vector<int>& own, const std::vector<Pose>& frames, const KinematicTargets& before,
                              double time);

/// The holders of a net likewise: hinges.
KinematicTargets find_net_targets(const std::vector<Vector3>& positions, const std::vector<Vector3>& velocities,
                                  const std::vector<Attachment>& attachments, const std::vector<int>& own,
                                  const std::vector<Pose>& frames, const KinematicTargets& before, double time);

/// How the holders of a cable or net that starts begin to move: as their frames do (`inputs`, by frame id) or, where that is not
/// given, as they will in their first step.
void start_targets(const std::vector<Attachment>& attachments, const std::vector<Pose>& frames, const BoundaryInputs& inputs,
                   double jump_speed, KinematicTargets& targets);

/// Sets where the holders will be at the end of a step that ends at `time`, `frames` being the poses then.
void aim_targets(const CableState& state, const std::vector<Attachment>& attachments, const std::vector<Pose>& frames,
                 double time, KinematicTargets& targets);

/// The same for one node, which is wanted at a place.
void aim_at(const Vector3& wanted, double time, KinematicTarget& target);

/// The same for hinges.
void aim_hinges(const std::vector<Attachment>& attachments, const std::vector<Pose>& frames, double time,
                KinematicTargets& targets);

/// Puts the holders where they aim; they move on as before.
void put_at_aim(KinematicTargets& targets);

/// What following the aims over a step found.
struct Following {
  bool started = false;   ///< a holder's velocity has become known
  int jumping_node = -1;  ///< the first whose holder jumps, -1: none does
};

/// A step, for frames.
struct FrameStep {
  double time_step = 0;   ///< [s]
  double jump_speed = 0;  ///< [m/s] a change of velocity by more, and not for long, is a jump
  bool is_judged = true;  ///< false: how far frames went says nothing of how fast they were, since time was left out
};

/// Sets how the holders move over a step that ends at `time`. Those that jump are taken as far as they jump, to be followed on
/// from there. Jumps that are over are added to `jumps`.
Following follow_aims(const std::vector<Attachment>& attachments, double time, const FrameStep& step, KinematicTargets& targets,
                      std::vector<Jump>& jumps);

/// What is held at the end of a substep that goes from one part of the step to another, 0 to 1.
void hold_at(double from, double to, const KinematicTargets& targets, Boundary& boundary);

/// The same of the directions alone.
void hold_directions_at(double from, double to, const KinematicTargets& targets, std::vector<HeldDirection>& directions);

/// Lets bodies hold what is theirs, from where they are now; `bodies` as World::bodies(), `time` at the end of the step.
void hold_on_bodies(const CableState& state, const std::vector<Attachment>& attachments, const std::vector<SimulatedBody>& bodies,
                    double time, const KinematicTargets& targets, Boundary& boundary);

/// The same of the directions alone.
void hold_directions_on_bodies(const std::vector<Attachment>& attachments, const std::vector<SimulatedBody>& bodies,
                               const KinematicTargets& targets, std::vector<HeldDirection>& directions);

/// Gaps of what bodies have caught, and did not hold `before`, close as seen from them.
void close_gaps_on_bodies(const std::vector<Attachment>& attachments, const std::vector<SimulatedBody>& bodies,
                          const KinematicTargets& before, KinematicTargets& targets);

/// Takes over where bodies, which have come to the end of the step, hold a cable.
void follow_bodies(const Boundary& boundary, KinematicTargets& targets);

/// Takes over how whole rods are twisted at their clamps after a substep.
void keep_twist(const Boundary& boundary, KinematicTargets& targets);

/// Takes over what holders have borne in a substep, as the next one is to know it.
void keep_lasting_forces(const Boundary& boundary, KinematicTargets& targets);

/// Whether a cable slides through any of its holders.
inline bool slides(const KinematicTargets& targets) {
  return std::any_of(targets.nodes.begin(), targets.nodes.end(), [](const KinematicTarget& target) { return target.slides; });
}

/// What is held at the world's time.
Boundary boundary_now(const KinematicTargets& targets);

/// The step is done: what was next is now.
void complete_step(double time_step, KinematicTargets& targets);

/// A holder that jumps keeps the velocity from before for its cable; its node shows the frame's if that is slower: what stands is
/// seen to stand. Before the next step it is taken back.
void show_velocities(const KinematicTargets& targets, std::vector<Vector3>& velocities);
void take_back_shown_velocities(const KinematicTargets& targets, std::vector<Vector3>& velocities);

}  // namespace verlet_cable

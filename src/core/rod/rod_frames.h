#pragma once

#include <functional>
#include <vector>

#include "rod/rod_joints.h"
#include "target/kinematic_targets.h"
#include "verlet_cable/core/cable.h"

namespace verlet_cable {

/// The material frames of whole rods beside their steps: where they are at first, how they follow what edits do, and what they
/// show. A joint between two frames stands for the cable halfway to the next ones.

/// Axes of the material on a segment, in columns: x along it, y its director.
Eigen::Matrix3d segment_frame(const CableState& state, int segment);

/// [m] of cable around a node, halfway to its neighbours.
double joint_length(const CableState& state, int node);

/// [rad] By which the material of a joint is twisted. At an end whose material resists no twist it is by none, however far the
/// clamp there has turned against it.
double material_twist(const CableModel& model, const CableState& state, int node);

/// The angles that `length` [m] of cable at a node has unloaded.
JointAngles rest_angles(const CableState& state, int node, double length);

/// The rotation from the one frame of a joint to the other, seen from the one.
Eigen::Matrix3d joint_rotation(const JointAngles& angles);

/// Axes of the material at a node where nothing but the cable's own stiffness acts: halfway between its segments; at an end as
/// the unloaded shape goes on from the segment.
Eigen::Matrix3d node_frame(const CableState& state, int node);

/// Axes of the cable at a node, also of one without frames: x along it.
Quaternion axes_at(const CableState& state, int node);

/// Gives a cable that needs them frames, in its rest twist: carried from the first clamp along it; without a clamp from the
/// smallest rotation that takes the fixed frame's x to the first segment. The other clamps hold the material as it comes to them,
/// whatever their frames' roll.
void start_frames(std::vector<DirectionTarget>& clamps, CableState& state);

/// Gives frames to a cable that has none yet and is to be a whole rod, twisted as it is; its clamps hold the material as it is.
void give_frames(CableState& state, std::vector<DirectionTarget>& clamps);

/// Takes them away from one that no longer needs them, its twist evenly spread between clamps.
void drop_frames(CableState& state, std::vector<DirectionTarget>& clamps);

/// Gives the segment between two cables that are being joined a frame, and the joint after it the twist that the two have against
/// each other, unloaded: they are welded as they come.
void weld_frames(int segment, CableState& state);

/// The director of a segment if it had the direction of `along` [m], and was turned about that by an angle [rad].
Vector3 carried_director(const CableState& state, int segment, const Vector3& along, double angle);

/// Turns a segment about its direction [rad].
void turn_segment(int segment, double angle, CableState& state);

/// Lets the material in a clamp at the cable's end be turned by `angle` [rad] against what it was, as other material comes there.
void turn_in_clamp(double angle, DirectionTarget& clamp);

/// Takes the frames along with segments that were moved from where their nodes were `before`.
void carry_frames(const std::vector<Vector3>& before, CableState& state);

/// Brings the twists of joints and clamps in line with frames and clamps that an edit has changed, each the nearest to what it
/// was: a clamp that has come between two segments shares the twist that they had, one that has become an end's has it in the
/// cable's state.
void measure_joint_twists(std::vector<DirectionTarget>& clamps, CableState& state);

/// After clamps were turned: the first one twists the cable by that, the others are rolled so that they do not.
void roll_clamps_to_twist(std::vector<DirectionTarget>& clamps, CableState& state);

/// Turns the clamps after the first that may be turned so that the cable has its rest twist, altogether, between each two of
/// them, and from the first clamp on. Returns the largest twist that was taken away [rad].
double take_excess_twist(std::vector<DirectionTarget>& clamps, const std::function<bool(const DirectionTarget&)>& may_turn,
                         CableState& state);

/// Leaves the twist of a clamp that lets go to its joint; an end that is free has none.
void release_joint_twist(const DirectionTarget& clamp, CableState& state);

/// Keeps the twist of clamps at the ends with them, for ends that will be inside.
void take_end_twists(CableState& state, std::vector<DirectionTarget>& clamps);

/// The angles of the joint at a node between two segments.
JointAngles joint_angles_at(const CableState& state, int node);

}  // namespace verlet_cable

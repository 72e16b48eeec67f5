#pragma once

#include <functional>
#include <vector>

#include "target/boundary.h"
#include "verlet_cable/core/cable.h"

namespace verlet_cable {

/// Bending between a clamp's axis and a segment beside it, over a substep: see Bending.
struct ClampJoint {
  int target = 0;                     ///< index of the held direction
  int segment = 0;                    ///< the segment next to the clamp
  bool is_elastic = false;            ///< that segment
  double inverse_length = 0;          ///< of the segment, at rest [1/m]
  double stiffness = 0, damping = 0;  ///< EI / length, and damping / (length h) [N m]
  Vector3 turn = Vector3::Zero();     ///< of e with the material in the clamp, a radian
  double angle = 0;                   ///< [rad] by which the clamp turns the material about its axis
  Vector3 start = Vector3::Zero(), axis_change = Vector3::Zero(), middle_axis = Vector3::Zero();
  double start_square = 0;
  Vector3 moment = Vector3::Zero();  ///< force times length, on the side's direction
  Vector3 torque = Vector3::Zero();  ///< on the axis [N m]
  double damping_work = 0;           ///< [J] that damping takes in the substep
  // Of elastic segments: d / l and the unit axis
  Vector3 start_direction = Vector3::Zero(), start_axis = Vector3::Zero(), end_axis = Vector3::Zero();
  double slope = 0;
};

/// Those of all clamps. `segment_at`: a segment at the start of the substep [m], by its index; `h`: in which damping acts [s];
/// `part`: where in the substep forces are taken, 1/2 or 1.
void find_clamp_joints(const CableModel& model, const CableState& state, const std::vector<HeldDirection>& directions,
                       const std::function<Vector3(int)>& segment_at, double h, double part, std::vector<ClampJoint>& joints);

/// Sets moment, torque and slope for a displacement of the segment's second node against its first [m].
void bend_clamp(double part, const Vector3& displacement, ClampJoint& clamp);

/// [N/m] of the segment's nodes against each other.
inline double stiffness_across(const ClampJoint& clamp, double part) {
  return (part * clamp.slope + clamp.damping) * clamp.inverse_length * clamp.inverse_length;
}

}  // namespace verlet_cable

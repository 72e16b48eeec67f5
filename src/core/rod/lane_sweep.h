#pragma once

namespace verlet_cable {

/// One Newton iteration of straight isotropic cables of equally many nodes, two lanes a cable: one comes from its start, one from
/// its end, and they meet in its middle. A sweep forward evaluates, assembles and eliminates node by node, one back solves. Wider
/// lanes compute more cables at once, each with the same operations, so that its numbers do not depend on the others.

/// Of a node and the segment to the next one, seen from a lane's end: the lanes of each value lie side by side.
enum class LaneField {
  segment_x,  ///< d at the start of the substep, towards the next node [m]
  segment_y,
  segment_z,
  displacement_x,  ///< in and out: u of the node [m]
  displacement_y,
  displacement_z,
  density,  ///< in and out: of the segment, 2 T / (s + s') [N/m]
  load_x,   ///< on the node, all that no iteration changes, and what `force` says [N]
  load_y,
  load_z,
  force_x,  ///< of the segment on the node, of what is evaluated elsewhere [N]
  force_y,
  force_z,
  inertia,          ///< of the node [kg/s^2]
  movable,          ///< of the node, 1 or 0
  stiffness,        ///< of the node, of what is evaluated elsewhere [N/m]
  coupling,         ///< likewise, to the next node
  compliance,       ///< of the segment, of what is pulled straight
  adjustable,       ///< 0 where both nodes of a segment are held, else 1
  target_length,    ///< of an inextensible segment, or the rest length [m]
  start_length,     ///< of an elastic segment [m]
  axial_stiffness,  ///< EA / rest length [N/m]
  axial_damping,    ///< in the substep [N/m]
  inverse_length,   ///< of the segment, at rest [1/m]
  joint_stiffness,  ///< of the node, EI / length [N m]; 0 at ends and clamps
  joint_damping,    ///< likewise, in the substep
  force_along,      ///< out: of bending and `force`, along the segment [N]
  count
};

/// What all cables of a sweep have in common.
struct LaneLaw {
  bool bends = false;
  bool is_elastic = false;
  double part = 0.5;  ///< where in the substep forces are taken

  bool operator==(const LaneLaw& other) const {
    return bends == other.bends && is_elastic == other.is_elastic && part == other.part;
  }
};

/// `records`: lane + 2; `eliminations`: room for `lane`.
struct LaneSweep {
  LaneLaw law;
  int lane;
  double* records;
  double* eliminations;
  const double* active;
  double* squares;
};
constexpr int elimination_size = 34;  ///< numbers a lane
void sweep_2_lanes(const LaneSweep& sweep);
void sweep_4_lanes(const LaneSweep& sweep);
void sweep_8_lanes(const LaneSweep& sweep);

}  // namespace verlet_cable

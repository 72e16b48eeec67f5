#pragma once

namespace verlet_cable {

/// A substep of several straight isotropic cables of equally many nodes at once, two lanes a cable: one comes from its start, one
/// from its end, and they meet in its middle. All that is known of a node and of the segment to the next one is a record; the
/// lanes of each of its values lie side by side. Every lane's operations are the same however many there are, so that a cable's
/// numbers do not depend on the others. The passes over the records, for lanes of each width, know nothing but numbers, as they
/// are compiled for different processors. What they compute is in CableStepper and Bending.

/// Of a node and the segment to the next one, seen from a lane's end.
enum class LaneField {
  segment_x,  ///< d at the start of the substep, towards the next node; after `finish` at its end [m]
  segment_y,
  segment_z,
  displacement_x,  ///< u of the node [m]
  displacement_y,
  displacement_z,
  density,  ///< of the segment, 2 T / (s + s') [N/m]
  load_x,   ///< on the node, all that no iteration changes [N]
  load_y,
  load_z,
  inertia,        ///< of the node [kg/s^2]
  movable,        ///< of the node, 1 or 0
  adjustable,     ///< 0 where both nodes of a segment are held, else 1
  target_length,  ///< of an inextensible segment, or the rest length [m]
  compliance,     ///< of an inextensible segment, see CableStepper
  velocity_x,     ///< of the node, at the start of the substep [m/s]; where held, so that the end velocity is the holder's
  velocity_y,
  velocity_z,
  start_acceleration_x,  ///< of the node, over the substep before [m/s^2]
  start_acceleration_y,
  start_acceleration_z,
  inverse_length,  ///< of the segment, at rest [1/m]
  inverse_mass,    ///< of the node [1/kg], 0 where held
  end_velocity_x,  ///< of the node [m/s]
  end_velocity_y,
  end_velocity_z,
  acceleration_x,  ///< of the node, over the substep [m/s^2]
  acceleration_y,
  acceleration_z,
  change_x,  ///< see UnresolvedMotion [m/s^2]
  change_y,
  change_z,
  turn_x,  ///< likewise
  turn_y,
  turn_z,
  pivot,    ///< of the velocity projection: inverse of the segment's row, eliminated up to there
  off,      ///< to the next row
  impulse,  ///< [kg/s]; after `finish` what of it acts
  // Of elastic cables
  start_length,     ///< of the segment [m]
  axial_stiffness,  ///< EA / rest length [N/m]
  axial_damping,    ///< in the substep [N/m]
  // Of cables that bend
  joint_stiffness,  ///< of the node, EI / length [N m]; 0 at ends and clamps
  clamp_force_x,    ///< of a clamp beside the segment on its first node [N]
  clamp_force_y,
  clamp_force_z,
  clamp_stiffness,  ///< of a clamp, on both nodes and against each other [N/m]
  force_along,      ///< of bending, along the segment [N]
  // Of damped bending
  joint_damping,  ///< of the node, as its stiffness, in the substep [N m]
  driven_x,       ///< of the node, see BendDamping
  driven_y,
  driven_z,
  turned_x,  ///< likewise
  turned_y,
  turned_z,
  count
};

/// What is the same for all cables of one sweep.
struct LaneLaw {
  bool bends = false;
  bool is_damped = false;  ///< bending is
  bool is_elastic = false;
  bool is_watched = false;  ///< for motion that is not resolved
  int segments = 0;
  double h = 0;  ///< [s]

  bool operator==(const LaneLaw& other) const {
    return bends == other.bends && is_damped == other.is_damped && is_elastic == other.is_elastic &&
           is_watched == other.is_watched && segments == other.segments && h == other.h;
  }
};

/// Values in a record: only those that cables of this law have.
inline int record_size(const LaneLaw& law) {
  return static_cast<int>(law.is_damped    ? LaneField::count
                          : law.bends      ? LaneField::joint_damping
                          : law.is_elastic ? LaneField::joint_stiffness
                                           : LaneField::start_length);
}

constexpr int most_lanes = 8;

/// A cable's numbers in and out: see CableState. Vectors are three numbers each.
struct LaneCable {
  double *positions, *velocities, *accelerations, *acceleration_changes, *turns;  // a node
  double *tension, *last_tension, *axial_multiplier;                              // a segment
  const double* masses;                                                           // a node
  const double* rest_lengths;                                                     // a segment
};

/// By lane.
struct alignas(64) LaneValues {
  double gravity_x[most_lanes], gravity_y[most_lanes], gravity_z[most_lanes];  ///< [m/s^2]
  double fluid_x[most_lanes], fluid_y[most_lanes], fluid_z[most_lanes];        ///< its velocity [m/s]
  double drag[most_lanes];                                                     ///< [kg/(m s)]
  double bending_stiffness[most_lanes];                                        ///< [N m^2]
  double axial_stiffness[most_lanes];                                          ///< [N]
  double axial_damping[most_lanes];                                            ///< in the substep [N]
  double active[most_lanes];                                                   ///< 1 where a correction is applied, else 0
  double projects[most_lanes];                                                 ///< 1 where velocities are projected, else 0
  double known[most_lanes];                                                    ///< see MotionCleaner::finds_unresolved
  double smooths[most_lanes];                                                  ///< 1 where the tension is a mean of two substeps
  double share[most_lanes];                                                    ///< of what turns, see BendDamping
  double mended[most_lanes];  ///< share of the impulses of the projection that acts
  double stores[most_lanes];  ///< 1 where the cable takes the result, else 0
  // Out
  double largest[most_lanes];                        ///< square of the largest correction [m^2]; infinite or NaN if one is
  double longest[most_lanes], shortest[most_lanes];  ///< squares, relative, of segments
  double along[most_lanes];                          ///< see BendDamping [N m]
  double ended[most_lanes];                          ///< [J] impulses of the projection times the rates that they end
  double product[most_lanes], square[most_lanes], mass[most_lanes];  ///< see MotionCleaner::finds_unresolved
};

struct MiddleElimination;

/// What the passes work on.
struct LaneWork {
  LaneLaw law;
  int last_node = 0;  ///< of an even number of nodes, padded by one that is held, after the end, where necessary
  bool padded = false;
  int lane = 0;                          ///< nodes that either lane eliminates; two are left in the middle
  int record = 0;                        ///< its size
  double* records = nullptr;             ///< lane + 1
  double* eliminations = nullptr;        ///< lane
  MiddleElimination* middles = nullptr;  ///< a cable
  const LaneCable* cables = nullptr;
  LaneValues* values = nullptr;
};
/// Numbers a lane.
inline int elimination_size(const LaneLaw& law) {
  return law.bends ? 35 : 22;
}

/// For lanes of one width.
struct LanePasses {
  int lanes;                             ///< two a cable
  void (*load)(const LaneWork&);         ///< records from cables, as if nothing held them
  void (*turn)(const LaneWork&);         ///< `along`, of damped bending
  void (*sweep)(const LaneWork&);        ///< a Newton iteration
  void (*light_sweep)(const LaneWork&);  ///< likewise, with the matrix of the last one
  void (*project)(const LaneWork&);      ///< velocities at the end, and impulses that end changes of length there
  void (*finish)(const LaneWork&);       ///< velocities with these, and accelerations
  void (*store)(const LaneWork&);        ///< cables from records
};
LanePasses passes_of_2_lanes();
LanePasses passes_of_4_lanes();
LanePasses passes_of_8_lanes();

}  // namespace verlet_cable

#pragma once

#include <limits>
#include <vector>

#include "chain/cable_point.h"
#include "guide/flow.h"
#include "law/winch.h"
#include "verlet_cable/core/cable.h"

namespace verlet_cable {

/// A node whose place and velocity are given at the end of a substep.
struct HeldNode {
  int node = 0;
  Vector3 position = Vector3::Zero();  ///< [m]
  Vector3 velocity = Vector3::Zero();  ///< [m/s]
  Vector3 force = Vector3::Zero();     ///< [N] out: what the cable exerts on the holder, mean over the substep
  /// [N] out: the part of it that comes of velocities which are mended once the substep has reached its end
  Vector3 mending_force = Vector3::Zero();
  /// [N] likewise, without the inertia of the node: what the cable's accelerations come of, in at the start and out at the end of
  /// the substep; see mean_force
  Vector3 lasting_force = Vector3::Zero();
  Vector3 displacement = Vector3::Zero();  ///< [m] out: of the node, over the substep
  /// [J] out: what the node gains where its holder's velocities at the start and the end are not those of its way
  double unresolved = 0;
  /// Of a body that moves freely, -1: none. Place and velocity are then found with the cable's, and those above are where that
  /// begins.
  int body = -1;
  Vector3 point = Vector3::Zero();  ///< [m] of the body that holds the node, in the axes of its frame
  bool at_junction = false;         ///< the body is one that joins cables
  bool slides = false;              ///< whether the cable's material flows through it
  int attachment = -1;              ///< that holds the node: a clamp may hold two

  /// `mass` [kg], `start`, of the node [m/s], and its way [m] in a substep of h [s].
  void follow(double mass, const Vector3& start, const Vector3& way, double h) {
    displacement = way;
    mending_force.setZero();
    unresolved = mass * (velocity - start).dot(0.5 * (start + velocity) - way / h);
  }
  /// `lasting_part`: by how much of it the accelerations at the end are mended.
  void mend(const Vector3& with_force, double lasting_part) {
    force += with_force;
    mending_force += with_force;
    lasting_force += lasting_part * with_force;
  }
};

/// A clamp's direction and roll at the start and the end of a substep.
struct HeldDirection {
  int node = 0;
  Quaternion start = Quaternion::Identity();  ///< x along the cable
  Quaternion end = Quaternion::Identity();
  Vector3 torque = Vector3::Zero();  ///< [N m] out: what the cable exerts on the holder, mean over the substep
  /// [N m] in and out, as HeldNode::lasting_force
  Vector3 lasting_torque = Vector3::Zero();
  /// [rad] of a whole rod: between the segment before and the clamp, and between the clamp and the segment after it. In: at the
  /// start, if the clamp is inside; out: at the end of the substep
  double twist_before = 0, twist_after = 0;
  int body = -1;                                ///< likewise
  Quaternion on_body = Quaternion::Identity();  ///< in the axes of the body's frame
};

/// A segment whose rest length changes.
struct GrowingSegment {
  int segment = 0;
  double growth = 0;  ///< [m/s] of its rest length, at the end of the substep: in as planned, out with what it grows beyond that
  double way = 0;     ///< [m] planned of the rest length in the substep; what is left of it after where the state is wound to:
  double left = 0;    ///< [m]
  WinchLaw law = {};  ///< of what it grows by beyond that
  double beyond = 0;  ///< [m] out: in the substep
  bool keeps_tension = false;  ///< out: whether the law's tension is that of the segment
};

/// A force on a node from outside.
struct NodeLoad {
  int node = 0;
  Vector3 force = Vector3::Zero();  ///< [N]
};

/// All that is given of a cable at a substep; held nodes and directions ascend by node.
struct Boundary {
  std::vector<HeldNode> nodes;
  std::vector<HeldDirection> directions;
  std::vector<GrowingSegment> growing;
  std::vector<GuidedFlow> flows;  ///< ascending likewise
  std::vector<NodeLoad> loads;
  /// [kg] Of all cables and bodies that are found together with it, where bodies that move freely hold it: what pulls at it may
  /// hang behind these.
  double joined_mass = 0;

  bool is_on_bodies() const;        ///< whether a body that moves freely holds any of it
  Vector3 load_on(int node) const;  ///< [N] from outside
};

/// A force on a point of a cable.
struct PointLoad {
  CablePoint point;
  Vector3 force = Vector3::Zero();  ///< [N]
};

/// By what the holders of a boundary move from one iterate to the next.
struct HolderMotion {
  std::vector<Vector3> displacements;  ///< one a held node [m]
  std::vector<Vector3> rotations;      ///< one a held direction [rad]
  std::vector<PointLoad> loads;        ///< that come with it

  void clear();  ///< nothing moves
};

/// What a cable exerts on the holders of a boundary.
struct HolderLoads {
  std::vector<Vector3> forces;         ///< one a held node [N]
  std::vector<Vector3> torques;        ///< one a held direction [N m]
  std::vector<Vector3> displacements;  ///< [m] of what is loaded, one a load of the motion
};

/// What becomes of spans that bodies have drawn out beyond their length.
struct DrawnOut {
  double drawn_in = std::numeric_limits<double>::infinity();  ///< [m] of what is too much, at most
  bool is_reported = false;                                   ///< whether they count among those whose first node is returned
};

/// A span of what cannot stretch, between holders on frames that are, or will be at once, further apart than it is long.
struct OverstretchedSpan {
  int first = 0, last = 0;  ///< nodes
  double strain = 0;        ///< by which the holders are too far apart at the end of the substep, not negative
  double share = 0;         ///< 0 to 1: how far it is on the way from a span that is straight to one that yields
};

/// The lengths [m] that the segments can keep: their rest lengths, but longer between holders on frames that are further apart
/// than the cable between them is long, by way of the guides that it slides through, where none of it can stretch. `held` ascends
/// by node; `lengths`: one a segment.
void reachable_lengths(const CableModel& model, const CableState& state, const std::vector<HeldNode>& held,
                       std::vector<double>& lengths);

/// A span that is drawn straight yields before it is, as what it pulls sideways would have to be stopped at once: its holders are
/// looked ahead, as they move in the substep.
struct YieldingAhead {
  double time = 0;     ///< [s]
  double substep = 1;  ///< [s]
};

/// The lengths [m] of the segments in a substep: what bodies have drawn out keeps its length but for what is drawn in again.
/// `spans`: those that yield to their holders. Returns the first node of a span that is too short, -1 if there is none.
int lengths_in_substep(const CableModel& model, const CableState& state, const Boundary& boundary, DrawnOut drawn_out,
                       const YieldingAhead& ahead, std::vector<double>& lengths, std::vector<OverstretchedSpan>& spans);

/// Whether there are such spans.
bool any_overstretched(const CableModel& model, const CableState& state, const Boundary& boundary, const YieldingAhead& ahead);

}  // namespace verlet_cable

#pragma once

#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// A point of a cable: on its centre line, or beside it, on the surface, carried along by the segments there as they turn. With
/// x the nodes, i the segment, f the fraction and n the normal, its displacement is
///   (1 - f) u_i + f u_(i+1) + along n . (own (u_(i+1) - u_i) + before (u_i - u_(i-1))),
/// linear in those of three nodes: what turns about the normal or the centre line itself moves no point of the line. Whatever
/// moves the nodes as one rigid body moves the point as that body does, so that nothing which turns together slips.
struct CablePoint {
  int cable = -1;  ///< -1: none
  int segment = 0;
  double fraction = 0;  ///< along the segment, 0 to 1
  // Beside the centre line
  Vector3 along = Vector3::Zero();   ///< unit vector of the cable's direction, along the surface
  Vector3 normal = Vector3::Zero();  ///< unit vector across it, away from the point
  double own = 0;                    ///< how far beside, over the length of the segment,
  double before = 0;                 ///< and of the one before it
};

/// Of a point, where `node(i)` is what each node has: displacements, velocities or accelerations.
template <class Nodes>
Vector3 at_point(const CablePoint& point, const Nodes& node) {
  const int i = point.segment;
  const Vector3 here = node(i), next = node(i + 1);
  double turned = point.own * point.normal.dot(next - here);
  if (point.before != 0) turned += point.before * point.normal.dot(here - node(i - 1));
  return (1 - point.fraction) * here + point.fraction * next + turned * point.along;
}

/// The same without what lies beside the centre line.
template <class Nodes>
Vector3 on_centre_line(const CablePoint& point, const Nodes& node) {
  return (1 - point.fraction) * node(point.segment) + point.fraction * node(point.segment + 1);
}

/// [m] What a force of one along the cable does to the moment about a place beside what it would do on the centre line.
/// `place(i)` [m]: of the nodes.
template <class Nodes>
Vector3 turning_arm(const CablePoint& point, const Nodes& place) {
  const int i = point.segment;
  const Vector3 here = place(i);
  Vector3 arm = point.own * (place(i + 1) - here).cross(point.normal);
  if (point.before != 0) arm += point.before * (here - place(i - 1)).cross(point.normal);
  return arm;
}

/// Calls add(node, force) for the forces on nodes that do the same work as a force on the point.
template <class Add>
void share_force(const CablePoint& point, const Vector3& force, const Add& add) {
  const int i = point.segment;
  const Vector3 next = point.fraction * force;
  const double couple = point.along.dot(force);
  const Vector3 own = (point.own * couple) * point.normal, before = (point.before * couple) * point.normal;
  add(i, Vector3(force - next + before - own));
  add(i + 1, Vector3(next + own));
  if (point.before != 0) add(i - 1, Vector3(-before));
}

}  // namespace verlet_cable

#pragma once

#include <vector>

#include "chain/cable_point.h"
#include "geometry/vector_array.h"

namespace verlet_cable {

/// Of the point of the centre line that is next to it, where `node(i)` is what each node has.
template <class Nodes>
Vector3 on_centre_line(const CablePoint& point, const Nodes& node) {
  return (1 - point.fraction) * node(point.segment) + point.fraction * node(point.segment + 1);
}

/// How far the segments' turning carries a point along, where `node(i)` is what each node has.
template <class Nodes>
double carried_along(const CablePoint& point, const Nodes& node) {
  const int i = point.segment;
  const double own = point.own * point.across.dot(node(i + 1) - node(i));
  return point.before == 0 ? own : own + point.before * point.across.dot(node(i) - node(i - 1));
}

/// Of a point, where `node(i)` is what each node has: displacements, velocities or accelerations.
template <class Nodes>
Vector3 at_point(const CablePoint& point, const Nodes& node) {
  const Vector3 on_line = on_centre_line(point, node);
  return point.own == 0 ? on_line : Vector3(on_line + carried_along(point, node) * point.along);
}

/// The same where the nodes' are in a list.
/// @{
inline Vector3 on_centre_line(const CablePoint& point, const std::vector<Vector3>& nodes) {
  return on_centre_line(point, [&](int i) -> const Vector3& { return nodes[i]; });
}
inline Vector3 at_point(const CablePoint& point, const std::vector<Vector3>& nodes) {
  return at_point(point, [&](int i) -> const Vector3& { return nodes[i]; });
}
inline Vector3 at_point(const CablePoint& point, const VectorArray& nodes) {
  return at_point(point, [&](int i) { return get(nodes, i); });
}
/// @}

/// [m] What a force of one along the cable does to the moment about a place beside what it would do on the centre line.
/// `place(i)` [m]: of the nodes.
template <class Nodes>
Vector3 turning_arm(const CablePoint& point, const Nodes& place) {
  const int i = point.segment;
  const Vector3 here = place(i);
  Vector3 arm = point.own * (place(i + 1) - here).cross(point.across);
  if (point.before != 0) arm += point.before * (here - place(i - 1)).cross(point.across);
  return arm;
}

/// Calls add(node, force) for the forces on nodes that do the same work as a force on the point.
template <class Add>
void share_force(const CablePoint& point, const Vector3& force, const Add& add) {
  const int i = point.segment;
  const Vector3 next = point.fraction * force, here = force - next;
  if (point.own == 0) {
    add(i, here);
    add(i + 1, next);
    return;
  }
  const double couple = point.along.dot(force);
  const Vector3 own = (point.own * couple) * point.across, before = (point.before * couple) * point.across;
  add(i, Vector3(here + before - own));
  add(i + 1, Vector3(next + own));
  if (point.before != 0) add(i - 1, Vector3(-before));
}

/// Adds a force at a point to the nodes that carry it.
inline void add_force(const CablePoint& point, const Vector3& force, VectorArray& nodes) {
  share_force(point, force, [&](int i, const Vector3& part) {
    nodes.x[i] += part.x();
    nodes.y[i] += part.y();
    nodes.z[i] += part.z();
  });
}

}  // namespace verlet_cable

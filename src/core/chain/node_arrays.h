#pragma once

#include "verlet_cable/core/cable.h"

namespace verlet_cable {

/// All arrays of a cable that have an entry a node or a segment, named here once: who cuts, joins, reverses and renumbers cables
/// does it by these functions. A new array is added to the two visits and to `append`. `cable`: a CableState, constant or not.
/// @{
template <class Cable, class Visitor>
void visit_node_arrays(Cable& cable, const Visitor& visitor) {
  visitor(cable.positions);
  visitor(cable.velocities);
  visitor(cable.accelerations);
  visitor(cable.unresolved.acceleration_changes);
  visitor(cable.unresolved.turns);
  visitor(cable.masses);
  if (!cable.rest_curvature.empty()) visitor(cable.rest_curvature);
  if (!cable.rest_twist.empty()) visitor(cable.rest_twist);
  if (!cable.flexible_fraction.empty()) visitor(cable.flexible_fraction);
  if (!cable.beyond_limits.empty()) visitor(cable.beyond_limits);
  if (!cable.joint_twist.empty()) visitor(cable.joint_twist);
}
template <class Cable, class Visitor>
void visit_segment_arrays(Cable& cable, const Visitor& visitor) {
  visitor(cable.rest_lengths);
  visitor(cable.tension);
  visitor(cable.last_tension);
  visitor(cable.axial_multiplier);
  visitor(cable.twist);
  if (!cable.section_material.empty()) visitor(cable.section_material);
  if (!cable.spin.empty()) visitor(cable.spin);
  if (!cable.directors.empty()) visitor(cable.directors);
  if (!cable.bending_memory.empty()) visitor(cable.bending_memory);
}
/// @}

/// Keeps the nodes `first` to `last` and the segments between them, and no memory for others.
void slice(int first, int last, CableState& cable);

/// From the end to the start.
void reverse_arrays(CableState& cable);

/// The nodes of `tail` follow those of `cable`, with a new segment in between: of no rest length, tension or twist. Either
/// both of them have frames or none.
void append(const CableState& tail, CableState& cable);

/// Another node with the same entries beside it, and a segment likewise.
void duplicate_node(int node, CableState& cable);
void duplicate_segment(int segment, CableState& cable);

void erase_node(int node, CableState& cable);
void erase_segment(int segment, CableState& cable);

}  // namespace verlet_cable

#pragma once

#include "verlet_cable/core/cable.h"

namespace verlet_cable {

/// All arrays of a cable that have an entry a node or a segment, named here once: who cuts, joins, reverses and renumbers cables
/// does it by these functions. A new array is added to the two visits, and to `append` if it may be empty.
/// @{
template <class Visitor>
void visit_node_arrays(SimulatedCable& cable, const Visitor& visitor) {
  visitor(cable.state.positions);
  visitor(cable.state.velocities);
  visitor(cable.state.accelerations);
  visitor(cable.model.masses);
  if (!cable.model.rest_curvature.empty()) visitor(cable.model.rest_curvature);
  if (!cable.model.rest_twist.empty()) visitor(cable.model.rest_twist);
  if (!cable.model.flexible_fraction.empty()) visitor(cable.model.flexible_fraction);
  if (!cable.state.joint_twist.empty()) visitor(cable.state.joint_twist);
}
template <class Visitor>
void visit_segment_arrays(SimulatedCable& cable, const Visitor& visitor) {
  visitor(cable.model.rest_lengths);
  visitor(cable.state.tension);
  visitor(cable.state.axial_multiplier);
  visitor(cable.state.twist);
  if (!cable.state.spin.empty()) visitor(cable.state.spin);
  if (!cable.state.directors.empty()) visitor(cable.state.directors);
}
/// @}

/// Keeps the nodes `first` to `last` and the segments between them.
void slice(int first, int last, SimulatedCable& cable);

/// From the end to the start.
void reverse_arrays(SimulatedCable& cable);

/// The nodes of `tail` follow those of `cable`, with a new segment in between: of no rest length, tension or twist. Either
/// both of them have frames or none.
void append(const SimulatedCable& tail, SimulatedCable& cable);

/// Another node with the same entries beside it, and a segment likewise.
void duplicate_node(int node, SimulatedCable& cable);
void duplicate_segment(int segment, SimulatedCable& cable);

void erase_node(int node, SimulatedCable& cable);
void erase_segment(int segment, SimulatedCable& cable);

}  // namespace verlet_cable

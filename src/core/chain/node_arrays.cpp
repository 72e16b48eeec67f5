#include "chain/node_arrays.h"

#include <algorithm>
#include <cassert>

namespace verlet_cable {

namespace {

template <class Array>
void keep(int first, int count, Array& array) {
  array = Array(array.begin() + first, array.begin() + first + count);
}

double zero_like(double) {
  return 0;
}
int zero_like(int) {
  return 0;
}
Vector3 zero_like(const Vector3&) {
  return Vector3::Zero();
}
std::array<HalfBend, 2> zero_like(const std::array<HalfBend, 2>&) {
  return {};
}

template <class Array>
void extend(const Array& tail, Array& array) {
  array.insert(array.end(), tail.begin(), tail.end());
}

/// Of arrays that are empty where every entry is `usual`: afterwards as long as the others, or empty.
template <class T>
void extend_where_needed(const std::vector<T>& tail, int tail_size, int size, const T& usual, std::vector<T>& array) {
  if (array.empty() && tail.empty()) return;
  array.resize(size, usual);
  extend(tail, array);
  array.resize(size + tail_size, usual);
}

}  // namespace

void slice(int first, int last, CableState& cable) {
  visit_node_arrays(cable, [&](auto& array) { keep(first, last - first + 1, array); });
  visit_segment_arrays(cable, [&](auto& array) { keep(first, last - first, array); });
}

void reverse_arrays(CableState& cable) {
  const auto reverse = [](auto& array) { std::reverse(array.begin(), array.end()); };
  visit_node_arrays(cable, reverse);
  visit_segment_arrays(cable, reverse);
}

void append(const CableState& tail, CableState& cable) {
  assert(cable.directors.empty() == tail.directors.empty());
  const int size = cable.nodes(), tail_size = tail.nodes();
  const std::array<double, 2> straight{0, 0};
  extend_where_needed(tail.rest_curvature, tail_size, size, straight, cable.rest_curvature);
  extend_where_needed(tail.flexible_fraction, tail_size, size, 1.0, cable.flexible_fraction);
  extend_where_needed(tail.beyond_limits, tail_size, size, std::array<int, 3>{0, 0, 0}, cable.beyond_limits);
  extend_where_needed(tail.rest_twist, tail_size, size, 0.0, cable.rest_twist);
  extend_where_needed(tail.joint_twist, tail_size, size, 0.0, cable.joint_twist);
  extend(tail.masses, cable.masses);
  extend(tail.positions, cable.positions);
  extend(tail.velocities, cable.velocities);
  extend(tail.accelerations, cable.accelerations);
  extend(tail.unresolved.acceleration_changes, cable.unresolved.acceleration_changes);
  extend(tail.unresolved.turns, cable.unresolved.turns);
  visit_segment_arrays(cable, [](auto& array) { array.push_back(zero_like(array.back())); });
  const int segments = cable.segments(), tail_segments = tail.segments();
  extend_where_needed(tail.section_material, tail_segments, segments, 0, cable.section_material);
  extend_where_needed(tail.spin, tail_segments, segments, 0.0, cable.spin);
  extend_where_needed<Vector3>(tail.directors, tail_segments, segments, Vector3::Zero(), cable.directors);
  extend_where_needed(tail.bending_memory, tail_segments, segments, {}, cable.bending_memory);
  extend(tail.rest_lengths, cable.rest_lengths);
  extend(tail.tension, cable.tension);
  extend(tail.last_tension, cable.last_tension);
  extend(tail.axial_multiplier, cable.axial_multiplier);
  extend(tail.twist, cable.twist);
}

void duplicate_node(int node, CableState& cable) {
  visit_node_arrays(cable, [&](auto& array) {
    const auto entry = array[node];
    array.insert(array.begin() + node, entry);
  });
}

void duplicate_segment(int segment, CableState& cable) {
  visit_segment_arrays(cable, [&](auto& array) {
    const auto entry = array[segment];
    array.insert(array.begin() + segment, entry);
  });
}

void erase_node(int node, CableState& cable) {
  visit_node_arrays(cable, [&](auto& array) { array.erase(array.begin() + node); });
}

void erase_segment(int segment, CableState& cable) {
  visit_segment_arrays(cable, [&](auto& array) { array.erase(array.begin() + segment); });
}

}  // namespace verlet_cable

#include "chain/node_arrays.h"

#include <algorithm>

namespace verlet_cable {

namespace {

template <class Array>
void keep(int first, int count, Array& array) {
  array.erase(array.begin() + first + count, array.end());
  array.erase(array.begin(), array.begin() + first);
}

double zero_like(double) {
  return 0;
}
Vector3 zero_like(const Vector3&) {
  return Vector3::Zero();
}

template <class Array>
void extend(const Array& tail, Array& array) {
  array.insert(array.end(), tail.begin(), tail.end());
}

/// Of arrays that are empty where every entry is `usual`.
template <class T>
void extend_where_needed(const std::vector<T>& tail, int tail_size, int size, const T& usual, std::vector<T>& array) {
  if (array.empty() && tail.empty()) return;
  array.resize(size, usual);
  extend(tail, array);
  array.resize(size + tail_size, usual);
}

}  // namespace

void slice(int first, int last, SimulatedCable& cable) {
  visit_node_arrays(cable, [&](auto& array) { keep(first, last - first + 1, array); });
  visit_segment_arrays(cable, [&](auto& array) { keep(first, last - first, array); });
}

void reverse_arrays(SimulatedCable& cable) {
  const auto reverse = [](auto& array) { std::reverse(array.begin(), array.end()); };
  visit_node_arrays(cable, reverse);
  visit_segment_arrays(cable, reverse);
}

void append(const SimulatedCable& tail, SimulatedCable& cable) {
  const int size = cable.model.nodes(), tail_size = tail.model.nodes();
  const std::array<double, 2> straight{0, 0};
  extend_where_needed(tail.model.rest_curvature, tail_size, size, straight, cable.model.rest_curvature);
  extend_where_needed(tail.model.flexible_fraction, tail_size, size, 1.0, cable.model.flexible_fraction);
  extend_where_needed(tail.model.rest_twist, tail_size, size, 0.0, cable.model.rest_twist);
  extend(tail.model.masses, cable.model.masses);
  extend(tail.state.positions, cable.state.positions);
  extend(tail.state.velocities, cable.state.velocities);
  extend(tail.state.accelerations, cable.state.accelerations);
  visit_segment_arrays(cable, [](auto& array) { array.push_back(zero_like(array.back())); });
  extend(tail.model.rest_lengths, cable.model.rest_lengths);
  extend(tail.state.tension, cable.state.tension);
  extend(tail.state.axial_multiplier, cable.state.axial_multiplier);
  extend(tail.state.twist, cable.state.twist);
  extend(tail.state.spin, cable.state.spin);
  extend(tail.state.directors, cable.state.directors);
  extend(tail.state.joint_twist, cable.state.joint_twist);
}

void duplicate_node(int node, SimulatedCable& cable) {
  visit_node_arrays(cable, [&](auto& array) {
    const auto entry = array[node];
    array.insert(array.begin() + node, entry);
  });
}

void duplicate_segment(int segment, SimulatedCable& cable) {
  visit_segment_arrays(cable, [&](auto& array) {
    const auto entry = array[segment];
    array.insert(array.begin() + segment, entry);
  });
}

void erase_node(int node, SimulatedCable& cable) {
  visit_node_arrays(cable, [&](auto& array) { array.erase(array.begin() + node); });
}

void erase_segment(int segment, SimulatedCable& cable) {
  visit_segment_arrays(cable, [&](auto& array) { array.erase(array.begin() + segment); });
}

}  // namespace verlet_cable

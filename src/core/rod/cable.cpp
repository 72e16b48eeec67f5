#include "verlet_cable/core/cable.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "geometry/segment_geometry.h"
#include "rod/material_frames.h"
#include "rod/rod_frames.h"
#include "verlet_cable/core/cable_materials.h"

namespace verlet_cable {

double CableState::length() const {
  return length(0, segments());
}

double CableState::length(int first, int last) const {
  return std::accumulate(rest_lengths.begin() + first, rest_lengths.begin() + last, 0.0);
}

std::vector<double> CableState::arc_length() const {
  std::vector<double> arc{0};
  for (const double l : rest_lengths) arc.push_back(arc.back() + l);
  return arc;
}

int find_material(const CableModel& model, const std::string& name) {
  if (name == model.material_name) return 0;
  const auto& others = model.section_materials;
  const auto found = std::find_if(others.begin(), others.end(), [&](const NamedMaterial& other) { return other.name == name; });
  return found == others.end() ? -1 : static_cast<int>(found - others.begin()) + 1;
}

bool is_whole_rod(const CableModel& model, const CableState& state) {
  if (!state.bending_memory.empty()) return true;
  return CableMaterials(model, state).any([&](const MaterialDesc& material) {
    const BendingStiffness& stiffness = material.bending_stiffness;
    // What damps bending passes a moment about the cable on, which does work where the cable is twisted.
    const bool damps_twisted = model.is_twisted && material.torsional_stiffness > 0 && material.bending_damping > 0;
    return !stiffness.is_isotropic() || material.remembers_bending() ||
           (stiffness.largest() > 0 && (model.turns_bodies || damps_twisted || !state.rest_curvature.empty())) ||
           (material.torsional_stiffness > 0 && !state.rest_twist.empty());
  });
}

std::vector<Quaternion> segment_orientations(const CableState& state) {
  const int n = state.segments();
  if (!state.directors.empty()) {
    std::vector<Quaternion> orientations;
    for (int i = 0; i < n; ++i) orientations.emplace_back(segment_frame(state, i));
    return orientations;
  }
  VectorArray segment, director;
  segment.assign(n, 0.0);
  director.assign(n, 0.0);
  for (int i = 0; i < n; ++i) set(segment, i, state.positions[i + 1] - state.positions[i]);
  carry_directors(state, segment, director);
  std::vector<Quaternion> orientations;
  for (int i = 0; i < n; ++i) {
    // What has no length, where both nodes are held at one place, is turned as what is before it.
    if (get(segment, i).isZero(0)) {
      orientations.push_back(i > 0 ? orientations.back() : Quaternion::Identity());
      continue;
    }
    Eigen::Matrix3d axes;
    axes.col(0) = get(segment, i).normalized();
    axes.col(2) = axes.col(0).cross(get(director, i)).normalized();
    axes.col(1) = axes.col(2).cross(axes.col(0));
    orientations.emplace_back(axes);
  }
  return orientations;
}

std::vector<double> node_curvature(const CableState& state) {
  std::vector<double> curvature;
  for (int i = 1; i < state.segments(); ++i) {
    const Vector3 before = state.positions[i] - state.positions[i - 1];
    const Vector3 after = state.positions[i + 1] - state.positions[i];
    const double angle = std::atan2(before.cross(after).norm(), before.dot(after));
    curvature.push_back(angle / (0.5 * (state.rest_lengths[i - 1] + state.rest_lengths[i])));
  }
  return curvature;
}

std::vector<double> node_twist(const CableState& state) {
  std::vector<double> twist;
  for (int i = 1; i < state.segments(); ++i) {
    if (state.directors.empty())
      twist.push_back(0.5 * (state.twist[i - 1] + state.twist[i]));
    else
      twist.push_back(joint_angles_at(state, i).twist / joint_length(state, i));
  }
  return twist;
}

double strain(const CableState& state, int segment) {
  return (state.positions[segment + 1] - state.positions[segment]).norm() / state.rest_lengths[segment] - 1;
}

NearestPoint nearest_point(const CableState& state, const Vector3& point) {
  NearestPoint nearest;
  nearest.distance = infinity;
  for (int i = 0; i < state.segments(); ++i) {
    const Vector3 &start = state.positions[i], &end = state.positions[i + 1];
    const double fraction = closest_fraction(start, end, point);
    const double distance = (start + fraction * (end - start) - point).norm();
    if (distance < nearest.distance) nearest = {i, fraction, distance};
  }
  return nearest;
}

}  // namespace verlet_cable

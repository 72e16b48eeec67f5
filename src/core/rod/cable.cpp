#include "verlet_cable/core/cable.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "rod/material_frames.h"
#include "rod/rod_frames.h"

namespace verlet_cable {

double CableModel::length() const {
  return length(0, segments());
}

double CableModel::length(int first, int last) const {
  return std::accumulate(rest_lengths.begin() + first, rest_lengths.begin() + last, 0.0);
}

std::vector<double> CableModel::arc_length() const {
  std::vector<double> arc{0};
  for (const double l : rest_lengths) arc.push_back(arc.back() + l);
  return arc;
}

std::vector<Quaternion> segment_orientations(const SimulatedCable& cable) {
  const int n = cable.model.segments();
  if (!cable.state.directors.empty()) {
    std::vector<Quaternion> orientations;
    for (int i = 0; i < n; ++i) orientations.emplace_back(segment_frame(cable.state, i));
    return orientations;
  }
  VectorArray segment, director;
  segment.assign(n, 0.0);
  director.assign(n, 0.0);
  for (int i = 0; i < n; ++i) set(segment, i, cable.state.positions[i + 1] - cable.state.positions[i]);
  carry_directors(cable.model, cable.state, segment, director);
  std::vector<Quaternion> orientations;
  for (int i = 0; i < n; ++i) {
    Eigen::Matrix3d axes;
    axes.col(0) = get(segment, i).normalized();
    axes.col(2) = axes.col(0).cross(get(director, i)).normalized();
    axes.col(1) = axes.col(2).cross(axes.col(0));
    orientations.emplace_back(axes);
  }
  return orientations;
}

std::vector<double> node_curvature(const SimulatedCable& cable) {
  std::vector<double> curvature;
  for (int i = 1; i < cable.model.segments(); ++i) {
    const Vector3 before = cable.state.positions[i] - cable.state.positions[i - 1];
    const Vector3 after = cable.state.positions[i + 1] - cable.state.positions[i];
    const double angle = std::atan2(before.cross(after).norm(), before.dot(after));
    curvature.push_back(angle / (0.5 * (cable.model.rest_lengths[i - 1] + cable.model.rest_lengths[i])));
  }
  return curvature;
}

std::vector<double> node_twist(const SimulatedCable& cable) {
  std::vector<double> twist;
  const CableState& state = cable.state;
  for (int i = 1; i < cable.model.segments(); ++i) {
    if (state.directors.empty())
      twist.push_back(0.5 * (state.twist[i - 1] + state.twist[i]));
    else
      twist.push_back(joint_angles_at(state, i).twist / joint_length(cable.model, i));
  }
  return twist;
}

double strain(const SimulatedCable& cable, int segment) {
  return (cable.state.positions[segment + 1] - cable.state.positions[segment]).norm() / cable.model.rest_lengths[segment] - 1;
}

NearestPoint nearest_point(const SimulatedCable& cable, const Vector3& point) {
  NearestPoint nearest;
  nearest.distance = infinity;
  for (int i = 0; i < cable.model.segments(); ++i) {
    const Vector3 start = cable.state.positions[i], along = cable.state.positions[i + 1] - start;
    const double square = along.squaredNorm();
    const double fraction = square > 0 ? std::clamp((point - start).dot(along) / square, 0.0, 1.0) : 0;
    const double distance = (start + fraction * along - point).norm();
    if (distance < nearest.distance) nearest = {i, fraction, distance};
  }
  return nearest;
}

}  // namespace verlet_cable

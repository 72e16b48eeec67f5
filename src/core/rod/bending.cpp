#include "rod/bending.h"

#include <algorithm>

#include "rod/angle_energy.h"
#include "rod/material_spin.h"

namespace verlet_cable {

void Bending::resize(int segments) {
  segments_ = segments;
  const std::size_t nodes = segments + 1;
  for (std::vector<double>* a : {&inverse_length_, &stiffness_, &damping_, &start_square_, &end_square_, &slope_, &spin_})
    a->assign(nodes, 0.0);
  for (VectorArray* a : {&start_, &change_, &moment_, &turned_}) a->assign(nodes, 0.0);
  clamps_.reserve(2 * nodes);
}

void Bending::start(const CableModel& model, const CableState& state, const VectorArray& segment,
                    const std::vector<HeldDirection>& directions, double h, double part) {
  const double stiffness = model.material.bending_stiffness.largest(), damping = model.material.bending_damping / h;
  active_ = state.directors.empty() && (stiffness > 0 || model.material.bending_damping > 0);
  if (!active_) return;
  part_ = part;
  is_elastic_ = model.material.axial_stiffness < infinity;
  for (int i = 0; i < segments_; ++i) inverse_length_[i] = 1 / state.rest_lengths[i];
  for (int i = 1; i < segments_; ++i) {
    const double joint = 1 / state.bending_length(i, 0.5 * (state.rest_lengths[i - 1] + state.rest_lengths[i]));
    stiffness_[i] = stiffness * joint;
    damping_[i] = damping * joint;
    const Vector3 e = inverse_length_[i] * get(segment, i) - inverse_length_[i - 1] * get(segment, i - 1);
    set(start_, i, e);
    start_square_[i] = e.squaredNorm();
  }
  clamps_.clear();
  for (std::size_t k = 0; k < directions.size(); ++k) {
    const HeldDirection& target = directions[k];
    stiffness_[target.node] = damping_[target.node] = 0;
    const Vector3 start_axis = target.start * Vector3::UnitX(), end_axis = target.end * Vector3::UnitX();
    for (const int i : {target.node - 1, target.node}) {
      if (i < 0 || i >= segments_) continue;
      ClampJoint clamp;
      clamp.target = static_cast<int>(k);
      clamp.segment = i;
      const double joint = 1 / state.bending_length(target.node, 0.5 * state.rest_lengths[i]);
      clamp.stiffness = stiffness * joint;
      clamp.damping = damping * joint;
      const double stretch = inverse_length_[i] * get(segment, i).norm();
      clamp.start = inverse_length_[i] * get(segment, i) - stretch * start_axis;
      clamp.start_square = clamp.start.squaredNorm();
      clamp.axis_change = stretch * (end_axis - start_axis);
      clamp.middle_axis = stretch * start_axis + part * clamp.axis_change;
      clamp.start_direction = inverse_length_[i] * get(segment, i);
      clamp.start_axis = start_axis;
      clamp.end_axis = end_axis;
      clamps_.push_back(clamp);
    }
  }
  is_damped_ = damping > 0;
  if (is_damped_) turn_with_material(model, state, segment, directions, h);
}

/// What of the change of e over the substep is the material's own turn, as far as it is known at the start.
void Bending::turn_with_material(const CableModel& model, const CableState& state, const VectorArray& segment,
                                 const std::vector<HeldDirection>& directions, double h) {
  find_material_spin(model, state, segment, directions, damping_, h, spin_);
  for (int i = 1; i < segments_; ++i) {
    const double spin = 0.5 * (spin_[i - 1] + spin_[i]);
    set(turned_, i, h * turning_rate(get(segment, i - 1), get(segment, i), spin, get(start_, i)));
  }
  for (ClampJoint& clamp : clamps_) {
    const HeldDirection& target = directions[clamp.target];
    clamp.turned = h * turning_rate(get(segment, clamp.segment), clamp.start_axis, spin_of(target, h), clamp.start);
  }
}

void Bending::add_segment_forces(const VectorArray& displacement, VectorArray& pull) {
  std::fill(end_square_.begin(), end_square_.end(), 0.0);
  for (auto component : {&VectorArray::x, &VectorArray::y, &VectorArray::z}) {
    const double *u = (displacement.*component).data(), *w = inverse_length_.data(), *e = (start_.*component).data();
    double *change = (change_.*component).data(), *square = end_square_.data();
#pragma GCC ivdep
    for (int i = 1; i < segments_; ++i) {
      change[i] = w[i] * (u[i + 1] - u[i]) - w[i - 1] * (u[i] - u[i - 1]);
      const double end = e[i] + change[i];
      square[i] += end * end;
    }
  }
  for (int i = 1; i < segments_; ++i) slope_[i] = stiffness_[i] * mean_slope(0.5 * start_square_[i], 0.5 * end_square_[i]);
  for (auto component : {&VectorArray::x, &VectorArray::y, &VectorArray::z}) {
    const double *w = inverse_length_.data(), *e = (start_.*component).data(), *change = (change_.*component).data();
    const double *slope = slope_.data(), *damping = damping_.data();
    double *moment = (moment_.*component).data(), *f = (pull.*component).data();
    if (is_damped_) {
      const double* turned = (turned_.*component).data();
#pragma GCC ivdep
      for (int i = 1; i < segments_; ++i)
        moment[i] = slope[i] * (e[i] + part_ * change[i]) + damping[i] * (change[i] - turned[i]);
    } else {
#pragma GCC ivdep
      for (int i = 1; i < segments_; ++i) moment[i] = slope[i] * (e[i] + part_ * change[i]);
    }
#pragma GCC ivdep
    for (int i = 0; i < segments_; ++i) f[i] += w[i] * (moment[i] - moment[i + 1]);
  }
  bend_clamps(displacement);
  for (const ClampJoint& clamp : clamps_) {
    const int i = clamp.segment;
    set(pull, i, get(pull, i) + inverse_length_[i] * clamp.moment);
  }
}

void Bending::bend_clamps(const VectorArray& displacement) {
  for (ClampJoint& clamp : clamps_) {
    const int i = clamp.segment;
    const Vector3 direction_change = inverse_length_[i] * (get(displacement, i + 1) - get(displacement, i));
    if (is_elastic_) {
      bend_elastic_clamp(direction_change, clamp);
      continue;
    }
    const Vector3 change = direction_change - clamp.axis_change;
    const Vector3 middle = clamp.start + part_ * change;
    clamp.slope = clamp.stiffness * mean_slope(0.5 * clamp.start_square, 0.5 * (clamp.start + change).squaredNorm());
    clamp.moment = clamp.slope * middle + clamp.damping * (change - clamp.turned);
    // The energy depends on the axis a through d / l - a: the torque on the axis is a x moment.
    clamp.torque = clamp.middle_axis.cross(clamp.moment);
  }
}

/// With q = d / l, its length r and the unit axis a, the energy is EI / l psi(u), u = |q - r a|^2 / 2 = r^2 - r c, c = q . a. Its
/// change over the substep is that of u times a mean slope, and
///   u' - u = ((2 - mean c / mean r) mean q - mean r mean a) . (q' - q) - mean r mean q . (a' - a),
/// which gives the mean moments that keep the energy. Only what is across the axis is damped.
void Bending::bend_elastic_clamp(const Vector3& change, ClampJoint& clamp) const {
  const Vector3 start = clamp.start_direction, end = start + change, axis_change = clamp.end_axis - clamp.start_axis;
  const Vector3 direction = start + part_ * change, axis = clamp.start_axis + part_ * axis_change;
  const auto at_part = [this](double from, double to) { return from + part_ * (to - from); };
  const double stretch = at_part(start.norm(), end.norm());
  const double along = at_part(start.dot(clamp.start_axis), end.dot(clamp.end_axis));
  const double slope =
      clamp.stiffness * mean_slope(0.5 * clamp.start_square, 0.5 * (end - end.norm() * clamp.end_axis).squaredNorm());
  clamp.slope = slope * (2 - along / stretch);
  const Vector3 bending = change - stretch * axis_change - clamp.turned;
  const Vector3 damping = clamp.damping * (bending - axis * (axis.dot(bending) / axis.squaredNorm()));
  clamp.moment = clamp.slope * direction - slope * stretch * axis + damping;
  clamp.torque = axis.cross(slope * stretch * direction + damping);
}

Vector3 Bending::damping_torque(const VectorArray& displacement) const {
  Vector3 torque = Vector3::Zero();
  if (!active_ || !is_damped_) return torque;
  for (int i = 1; i < segments_; ++i) {
    const Vector3 change = inverse_length_[i] * (get(displacement, i + 1) - get(displacement, i)) -
                           inverse_length_[i - 1] * (get(displacement, i) - get(displacement, i - 1));
    torque -= damping_[i] * (get(start_, i) + part_ * change).cross(change - get(turned_, i));
  }
  return torque;
}

void Bending::add_stiffness(KktSystem& system) const {
  const auto add = [&system](int i, double value) { system.diagonal[i] += value; };
  for (int i = 1; i < segments_; ++i) {
    const double slope = part_ * slope_[i] + damping_[i], before = inverse_length_[i - 1], after = inverse_length_[i];
    add(i - 1, slope * before * before);
    add(i, slope * (before + after) * (before + after));
    add(i + 1, slope * after * after);
    system.first[i - 1] -= slope * before * (before + after);
    system.first[i] -= slope * after * (before + after);
    system.second[i - 1] = slope * before * after;
  }
  for (const ClampJoint& clamp : clamps_) {
    const int i = clamp.segment;
    const double slope = (part_ * clamp.slope + clamp.damping) * inverse_length_[i] * inverse_length_[i];
    add(i, slope);
    add(i + 1, slope);
    system.first[i] -= slope;
  }
}

void Bending::react(const VectorArray& displacement, std::vector<HeldDirection>& directions) {
  bend_clamps(displacement);
  for (const ClampJoint& clamp : clamps_) directions[clamp.target].torque += clamp.torque;
}

double bending_energy(const CableModel& model, const CableState& state, const std::vector<HeldDirection>& directions) {
  const int n = state.segments();
  const auto direction = [&](int i) -> Vector3 { return (state.positions[i + 1] - state.positions[i]) / state.rest_lengths[i]; };
  const auto joint = [](double length, const Vector3& change) { return angle_energy(0.5 * change.squaredNorm()) / length; };
  double energy = 0;
  for (int i = 1; i < n; ++i) {
    const auto clamped = std::find_if(directions.begin(), directions.end(), [i](const HeldDirection& d) { return d.node == i; });
    const double length = state.bending_length(i, 0.5 * (state.rest_lengths[i - 1] + state.rest_lengths[i]));
    if (clamped == directions.end()) energy += joint(length, direction(i) - direction(i - 1));
  }
  for (const HeldDirection& clamp : directions) {
    for (const int i : {clamp.node - 1, clamp.node}) {
      if (i < 0 || i >= n) continue;
      const double length = state.bending_length(clamp.node, 0.5 * state.rest_lengths[i]);
      energy += joint(length, direction(i) - direction(i).norm() * (clamp.end * Vector3::UnitX()));
    }
  }
  return model.material.bending_stiffness.largest() * energy;
}

}  // namespace verlet_cable

#include "rod/twist.h"

#include <algorithm>
#include <cmath>

#include "rod/material_frames.h"

namespace verlet_cable {

namespace {

struct Torsion {
  double stiffness = 0, damping = 0;  ///< [N m^2], [N m^2 s]
};

Torsion torsion_at(const CableMaterials& materials, int segment) {
  const MaterialDesc& material = materials[segment];
  if (material.bending_stiffness.largest() == 0) return {};
  return {material.torsional_stiffness, material.torsional_damping};
}

/// Substeps between two measurements of the angles, which cost as much as an iteration.
constexpr int measuring_interval = 16;

}  // namespace

double torsional_stiffness_at(const CableMaterials& materials, int segment) {
  return torsion_at(materials, segment).stiffness;
}

Series torsion_of(const CableMaterials& materials, const CableState& state, int first, int last) {
  Series series;
  for (int i = first; i < last; ++i) {
    const Torsion torsion = torsion_at(materials, i);
    series.add(state.rest_lengths[i], torsion.stiffness, torsion.damping);
  }
  return series;
}

double twist_share(const Series& series, const CableMaterials& materials, const CableState& state, int segment) {
  const Torsion torsion = torsion_at(materials, segment);
  return series.share(state.rest_lengths[segment], torsion.stiffness, torsion.damping);
}

void spread_twist(const CableModel& model, const std::vector<TwistSpan>& spans, CableState& state) {
  const CableMaterials materials(model, state);
  std::fill(state.twist.begin(), state.twist.end(), 0.0);
  for (const TwistSpan& span : spans) {
    if (materials.vary()) {
      const Series series = torsion_of(materials, state, span.first_node, span.last_node);
      for (int i = span.first_node; i < span.last_node; ++i)
        state.twist[i] = span.angle * twist_share(series, materials, state, i) / state.rest_lengths[i];
    } else {
      const double length = state.length(span.first_node, span.last_node);
      std::fill(state.twist.begin() + span.first_node, state.twist.begin() + span.last_node, span.angle / length);
    }
  }
}

double relative_roll(const Quaternion& first, const Quaternion& last, const Vector3* nodes, int count) {
  Vector3 direction = first * Vector3::UnitX(), normal = first * Vector3::UnitY();
  for (int i = 0; i + 1 < count; ++i) {
    const Vector3 next = (nodes[i + 1] - nodes[i]).normalized();
    normal = parallel_transport(normal, direction, next);
    direction = next;
  }
  const Vector3 axis = last * Vector3::UnitX();
  normal = parallel_transport(normal, direction, axis);
  const Vector3 held = last * Vector3::UnitY();
  return std::atan2(normal.cross(held).dot(axis), normal.dot(held));
}

void Twist::resize(int segments) {
  const std::size_t nodes = segments + 1;
  tangent_.assign(nodes, 0.0);
  binormal_.assign(nodes, 0.0);
  slope_.assign(nodes, 0.0);
  inverse_length_.assign(nodes, 0.0);
  states_.reserve(nodes);
  resistances_.reserve(nodes);
}

void Twist::start(const CableModel& model, const CableState& state, const std::vector<TwistSpan>& spans, double h, double part) {
  spans_ = nullptr;
  const CableMaterials materials(model, state);
  const auto resists = [](const MaterialDesc& material) {
    return material.torsional_stiffness != 0 || material.torsional_damping != 0;
  };
  if (spans.empty() || !materials.any(resists)) return;
  spans_ = &spans;
  part_ = part;
  states_.resize(spans.size());
  resistances_.resize(spans.size());
  for (std::size_t k = 0; k < spans.size(); ++k) {
    if (materials.vary()) {
      const Series series = torsion_of(materials, state, spans[k].first_node, spans[k].last_node);
      resistances_[k] = {series.stiffness(), series.damping() / h};
      continue;
    }
    const double length = state.length(spans[k].first_node, spans[k].last_node);
    resistances_[k] = {model.material.torsional_stiffness / length, model.material.torsional_damping / (length * h)};
  }
}

void Twist::add_segment_forces(const VectorArray& middle, const VectorArray& displacement, const Boundary& boundary,
                               VectorArray& pull) {
  const std::vector<TwistSpan>& spans = *spans_;
  for (std::size_t k = 0; k < spans.size(); ++k) {
    const TwistSpan& span = spans[k];
    SpanState& state = states_[k];
    const HeldDirection &first = boundary.directions[span.first_holder], &last = boundary.directions[span.last_holder];
    const Vector3 first_turn = rotation_between(first.start, first.end), last_turn = rotation_between(last.start, last.end);
    state.first_axis = first.start.slerp(part_, first.end) * Vector3::UnitX();
    state.last_axis = last.start.slerp(part_, last.end) * Vector3::UnitX();

    set_tangents(middle, span);
    state.first_binormal = curvature_binormal(state.first_axis, get(tangent_, span.first_node));
    state.last_binormal = curvature_binormal(get(tangent_, span.last_node - 1), state.last_axis);
    set_binormals(span, state);

    // Change of the angle over the substep: the clamps' own turns and the change of the directions between them.
    double& change = state.change;
    change = last_turn.dot(state.last_axis) - first_turn.dot(state.first_axis);
    change += 0.5 * state.first_binormal.dot(first_turn.cross(state.first_axis));
    change += 0.5 * state.last_binormal.dot(last_turn.cross(state.last_axis));
    for (auto component : {&VectorArray::x, &VectorArray::y, &VectorArray::z})
      change += add_slopes(displacement, span, component);
    state.torque = resistances_[k].stress(span.angle + part_ * change, change);
    for (auto component : {&VectorArray::x, &VectorArray::y, &VectorArray::z}) {
      const double *slope = (slope_.*component).data(), torque = state.torque;
      double* f = (pull.*component).data();
#pragma GCC ivdep
      for (int i = span.first_node; i < span.last_node; ++i) f[i] += torque * slope[i];
    }
  }
}

void Twist::set_tangents(const VectorArray& middle, const TwistSpan& span) {
  const double *x = middle.x.data(), *y = middle.y.data(), *z = middle.z.data();
  double *tx = tangent_.x.data(), *ty = tangent_.y.data(), *tz = tangent_.z.data(), *inverse = inverse_length_.data();
#pragma GCC ivdep
  for (int i = span.first_node; i < span.last_node; ++i) {
    inverse[i] = 1 / std::sqrt(x[i] * x[i] + y[i] * y[i] + z[i] * z[i]);
    tx[i] = inverse[i] * x[i];
    ty[i] = inverse[i] * y[i];
    tz[i] = inverse[i] * z[i];
  }
}

void Twist::set_binormals(const TwistSpan& span, const SpanState& state) {
  const double *x = tangent_.x.data(), *y = tangent_.y.data(), *z = tangent_.z.data();
  double *bx = binormal_.x.data(), *by = binormal_.y.data(), *bz = binormal_.z.data();
#pragma GCC ivdep
  for (int i = span.first_node + 1; i < span.last_node; ++i) {
    const double cosine = x[i - 1] * x[i] + y[i - 1] * y[i] + z[i - 1] * z[i];
    const double scale = 2 / std::max(1 + cosine, smallest_turn);
    bx[i] = scale * (y[i - 1] * z[i] - z[i - 1] * y[i]);
    by[i] = scale * (z[i - 1] * x[i] - x[i - 1] * z[i]);
    bz[i] = scale * (x[i - 1] * y[i] - y[i - 1] * x[i]);
  }
  set(binormal_, span.first_node, state.first_binormal);
  set(binormal_, span.last_node, state.last_binormal);
}

/// The derivative of the angle by each segment; its part of the change of the angle.
double Twist::add_slopes(const VectorArray& displacement, const TwistSpan& span, std::vector<double> VectorArray::*component) {
  const double *b = (binormal_.*component).data(), *u = (displacement.*component).data(), *inverse = inverse_length_.data();
  double* slope = (slope_.*component).data();
#pragma GCC ivdep
  for (int i = span.first_node; i < span.last_node; ++i) slope[i] = 0.5 * inverse[i] * (b[i] + b[i + 1]);
  // Two sums, so that one addition need not wait for the other.
  double even = 0, odd = 0;
  int i = span.first_node;
  for (; i + 1 < span.last_node; i += 2) {
    even += slope[i] * (u[i + 1] - u[i]);
    odd += slope[i + 1] * (u[i + 2] - u[i + 1]);
  }
  if (i < span.last_node) even += slope[i] * (u[i + 1] - u[i]);
  return even + odd;
}

namespace {

double measured_roll(const TwistSpan& span, const std::vector<HeldDirection>& directions, const std::vector<Vector3>& positions) {
  return relative_roll(directions[span.first_holder].end, directions[span.last_holder].end, positions.data() + span.first_node,
                       span.last_node - span.first_node + 1);
}

}  // namespace

void measure_twist(const std::vector<HeldDirection>& directions, const std::vector<Vector3>& positions,
                   std::vector<TwistSpan>& spans) {
  for (TwistSpan& span : spans) {
    span.angle += std::remainder(measured_roll(span, directions, positions) - span.origin - span.angle, 2 * M_PI);
    span.age = 0;
  }
}

void Twist::follow(const std::vector<HeldDirection>& directions, const std::vector<Vector3>& positions,
                   std::vector<TwistSpan>& spans) const {
  for (std::size_t k = 0; k < spans.size(); ++k) spans[k].angle += states_[k].change;
  // All spans of a cable are of the same age.
  if (++spans.front().age >= measuring_interval) measure_twist(directions, positions, spans);
}

std::vector<TwistSpan> find_spans(const CableState& state, const std::vector<HeldDirection>& directions) {
  std::vector<TwistSpan> spans;
  if (!state.directors.empty()) return spans;
  for (std::size_t k = 0; k + 1 < directions.size(); ++k) {
    TwistSpan span;
    span.first_holder = static_cast<int>(k);
    span.last_holder = span.first_holder + 1;
    span.first_node = directions[k].node;
    span.last_node = directions[k + 1].node;
    for (int i = span.first_node; i < span.last_node; ++i) span.angle += state.twist[i] * state.rest_lengths[i];
    spans.push_back(span);
  }
  for (TwistSpan& span : spans) span.origin = measured_roll(span, directions, state.positions) - span.angle;
  return spans;
}

double Twist::damping_work() const {
  double work = 0;
  for (std::size_t k = 0; k < spans_->size(); ++k) work += resistances_[k].loss(states_[k].change);
  return work;
}

void Twist::react(Boundary& boundary) const {
  for (std::size_t k = 0; k < spans_->size(); ++k) {
    const SpanState& state = states_[k];
    boundary.directions[(*spans_)[k].first_holder].torque +=
        state.torque * (state.first_axis - 0.5 * state.first_axis.cross(state.first_binormal));
    boundary.directions[(*spans_)[k].last_holder].torque -=
        state.torque * (state.last_axis + 0.5 * state.last_axis.cross(state.last_binormal));
  }
}

}  // namespace verlet_cable

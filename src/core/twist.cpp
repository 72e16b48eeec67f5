#include "twist.h"

#include <algorithm>
#include <cmath>

#include "material_frames.h"

namespace verlet_cable {

namespace {

/// Curvature binormal of two directions: 2 tan(angle / 2), about the axis of the turn.
Vector3 curvature_binormal(const Vector3& before, const Vector3& after) {
  return 2 / std::max(1 + before.dot(after), 1e-6) * before.cross(after);
}

/// Rotation vector of the small rotation from one orientation to another.
Vector3 rotation_between(const Quaternion& from, const Quaternion& to) {
  const Eigen::AngleAxisd rotation(to * from.conjugate());
  const double angle = rotation.angle() > M_PI ? rotation.angle() - 2 * M_PI : rotation.angle();
  return angle * rotation.axis();
}

}  // namespace

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

void Twist::resize(const CableModel& model) {
  const std::size_t nodes = model.nodes();
  tangent_.assign(nodes, 0.0);
  binormal_.assign(nodes, 0.0);
  inverse_length_.assign(nodes, 0.0);
  states_.reserve(nodes);
  stiffness_.reserve(nodes);
  damping_.reserve(nodes);
}

void Twist::start(const CableModel& model, const std::vector<TwistSpan>& spans, double h, double part) {
  spans_ = nullptr;
  if (spans.empty() || (model.material.torsional_stiffness == 0 && model.material.torsional_damping == 0)) return;
  spans_ = &spans;
  part_ = part;
  states_.resize(spans.size());
  stiffness_.resize(spans.size());
  damping_.resize(spans.size());
  for (std::size_t k = 0; k < spans.size(); ++k) {
    double length = 0;
    for (int i = spans[k].first_node; i < spans[k].last_node; ++i) length += model.rest_lengths[i];
    stiffness_[k] = model.material.torsional_stiffness / length;
    damping_[k] = model.material.torsional_damping / (length * h);
  }
}

void Twist::add_pulls(const VectorArray& middle, const VectorArray& displacement, const Boundary& boundary, VectorArray& pull) {
  const std::vector<TwistSpan>& spans = *spans_;
  for (std::size_t k = 0; k < spans.size(); ++k) {
    const TwistSpan& span = spans[k];
    SpanState& state = states_[k];
    const HeldDirection &first = boundary.directions[span.first_holder], &last = boundary.directions[span.last_holder];
    const Vector3 first_turn = rotation_between(first.start, first.end), last_turn = rotation_between(last.start, last.end);
    state.first_axis = first.start.slerp(part_, first.end) * Vector3::UnitX();
    state.last_axis = last.start.slerp(part_, last.end) * Vector3::UnitX();

    for (int i = span.first_node; i < span.last_node; ++i) {
      const Vector3 d = get(middle, i);
      inverse_length_[i] = 1 / d.norm();
      set(tangent_, i, inverse_length_[i] * d);
    }
    state.first_binormal = curvature_binormal(state.first_axis, get(tangent_, span.first_node));
    state.last_binormal = curvature_binormal(get(tangent_, span.last_node - 1), state.last_axis);
    set(binormal_, span.first_node, state.first_binormal);
    for (int i = span.first_node + 1; i < span.last_node; ++i)
      set(binormal_, i, curvature_binormal(get(tangent_, i - 1), get(tangent_, i)));

    // Change of the angle over the substep: the clamps' own turns and the change of the directions between them.
    double change = last_turn.dot(state.last_axis) - first_turn.dot(state.first_axis);
    change += 0.5 * state.first_binormal.dot(first_turn.cross(state.first_axis));
    change += 0.5 * state.last_binormal.dot(last_turn.cross(state.last_axis));
    for (int i = span.first_node; i < span.last_node; ++i) {
      const Vector3 after = i + 1 < span.last_node ? get(binormal_, i + 1) : state.last_binormal;
      const Vector3 slope = 0.5 * inverse_length_[i] * (get(binormal_, i) + after);
      set(tangent_, i, slope);  // from here on the derivative of the angle by the segment
      change += slope.dot(get(displacement, i + 1) - get(displacement, i));
    }
    state.torque = stiffness_[k] * (span.angle + part_ * change) + damping_[k] * change;
    for (int i = span.first_node; i < span.last_node; ++i) set(pull, i, get(pull, i) + state.torque * get(tangent_, i));
  }
}

void follow_roll(const std::vector<HeldDirection>& directions, const std::vector<Vector3>& positions,
                 std::vector<TwistSpan>& spans) {
  for (TwistSpan& span : spans) {
    const double roll = relative_roll(directions[span.first_holder].end, directions[span.last_holder].end,
                                      positions.data() + span.first_node, span.last_node - span.first_node + 1);
    span.angle += std::remainder(roll - span.roll, 2 * M_PI);
    span.roll = roll;
  }
}

std::vector<TwistSpan> find_spans(const CableModel& model, const CableState& state,
                                  const std::vector<HeldDirection>& directions) {
  std::vector<TwistSpan> spans;
  for (std::size_t k = 0; k + 1 < directions.size(); ++k) {
    TwistSpan span;
    span.first_holder = static_cast<int>(k);
    span.last_holder = span.first_holder + 1;
    span.first_node = directions[k].node;
    span.last_node = directions[k + 1].node;
    for (int i = span.first_node; i < span.last_node; ++i) span.angle += state.twist[i] * model.rest_lengths[i];
    spans.push_back(span);
  }
  // Their rolls are measured from here on.
  std::vector<TwistSpan> measured = spans;
  follow_roll(directions, state.positions, measured);
  for (std::size_t k = 0; k < spans.size(); ++k) spans[k].roll = measured[k].roll;
  return spans;
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

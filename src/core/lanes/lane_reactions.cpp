#include "geometry/eigen_vectors.h"
#include "lanes/lane_stepper.h"
#include "law/bend.h"

namespace verlet_cable {

/// What the held nodes' equations of motion lack is what their holders supply.
void LaneStepper::react(int c, LaneMember& member) {
  Boundary& boundary = member.substep.boundary;
  const CableState& state = *member.state;
  const double h = member.substep.h;
  const MaterialDesc& material = member.substep.model.material;
  for (HeldDirection& target : boundary.directions) target.torque.setZero();
  if (work_.law.bends) {
    bend_clamps(c, member);
    for (const ClampJoint& clamp : clamps_[c]) boundary.directions[clamp.target].torque += clamp.torque;
    if (work_.law.is_damped && !boundary.directions.empty()) {
      read_displacement(c);
      bendings_[c].turn_clamps(displacement_, boundary.directions);
    }
  }
  for (HeldDirection& target : boundary.directions) target.lasting_torque = target.torque;
  for (HeldNode& target : boundary.nodes) {
    const int i = target.node;
    const Vector3 flow = member.substep.environment.fluid.velocity - vector_at(LaneField::displacement_x, c, i) / h;
    double length = 0;
    target.force = Vector3::Zero();
    target.follow(state.masses[i], state.velocities[i], vector_at(LaneField::displacement_x, c, i), h);
    if (i > 0) {
      length += 0.5 * state.rest_lengths[i - 1];
      target.force -= force_of(c, i - 1);
    }
    if (i < state.segments()) {
      length += 0.5 * state.rest_lengths[i];
      target.force += force_of(c, i);
    }
    const Vector3 acceleration = (target.velocity - state.velocities[i]) / h;
    target.force +=
        material.drag * length * flow + state.masses[i] * (member.substep.environment.gravity.acceleration - acceleration);
    target.lasting_force = target.force + state.masses[i] * acceleration;
  }
}

/// What the segments exert on the other nodes they exert on the holders.
void LaneStepper::react_to_projection(int c, LaneMember& member) {
  for (HeldNode& target : member.substep.boundary.nodes) target.mend(impulse_on(c, target.node) / member.substep.h, 1);
}

/// Of the projection, on a held node [N s].
Vector3 LaneStepper::impulse_on(int c, int node) {
  const auto exerted = [&](int segment) -> Vector3 {
    double impulse = 0;
    each_lane_of(c, segment, [&](int place, int lane, double) { impulse = value(LaneField::impulse, place, lane); });
    return impulse * segment_at(LaneField::segment_x, c, segment);
  };
  Vector3 impulse = Vector3::Zero();
  if (node > 0) impulse += exerted(node - 1);
  if (node < work_.law.segments) impulse -= exerted(node);
  return impulse;
}

/// As CableStepper::scale_to_lose.
void LaneStepper::scale_to_lose(int c, const LaneMember& member) {
  const double ended = values_.ended[2 * c] + values_.ended[2 * c + 1];
  values_.mended[2 * c] = values_.mended[2 * c + 1] = losing_share_of_projection(
      member.substep.boundary.nodes, member.substep.h, ended, [&](int node) { return impulse_on(c, node); });
}

/// The force on a segment's first node [N].
Vector3 LaneStepper::force_of(int c, int i) {
  const Vector3 start = segment_at(LaneField::segment_x, c, i);
  const Vector3 change = vector_at(LaneField::displacement_x, c, i + 1) - vector_at(LaneField::displacement_x, c, i);
  double density = 0;
  each_lane_of(c, i, [&](int place, int lane, double) { density = value(LaneField::density, place, lane); });
  Vector3 force = density * (start + 0.5 * change);
  if (!work_.law.bends) return force;
  double inverse = 0;
  each_lane_of(c, i, [&](int place, int lane, double) { inverse = value(LaneField::inverse_length, place, lane); });
  force += segment_at(LaneField::clamp_force_x, c, i);
  if (i > 0) force += inverse * joint_moment(c, i);
  if (i + 1 < work_.law.segments) force -= inverse * joint_moment(c, i + 1);
  return force;
}

/// Of the difference of the directions at an inner node, over the substep.
Vector3 LaneStepper::direction_change(int c, int i) {
  const Vector3 before = vector_at(LaneField::displacement_x, c, i - 1), here = vector_at(LaneField::displacement_x, c, i),
                after = vector_at(LaneField::displacement_x, c, i + 1);
  return over_length(c, i, after - here) - over_length(c, i - 1, here - before);
}

Vector3 LaneStepper::over_length(int c, int segment, const Vector3& vector) {
  double inverse = 0;
  each_lane_of(c, segment, [&](int place, int lane, double) { inverse = value(LaneField::inverse_length, place, lane); });
  return inverse * vector;
}

/// On the change of direction at an inner node [N m].
Vector3 LaneStepper::joint_moment(int c, int i) {
  const Vector3 start = over_length(c, i, segment_at(LaneField::segment_x, c, i)) -
                        over_length(c, i - 1, segment_at(LaneField::segment_x, c, i - 1));
  const VectorOf<double> change = numbers_of(direction_change(c, i));
  const Bend<double> joint = bend(at(LaneField::joint_stiffness, c, i), numbers_of(start), start.squaredNorm(), change, 0.5);
  if (!work_.law.is_damped) return vector_of(joint.moment);
  return vector_of(joint.moment + bendings_[c].damping_at(i).moment(change, values_.share[2 * c]));
}

}  // namespace verlet_cable

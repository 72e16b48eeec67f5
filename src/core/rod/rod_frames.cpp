#include "rod/rod_frames.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "rod/material_frames.h"
#include "verlet_cable/core/cable_materials.h"
#include "verlet_cable/core/rotation.h"

namespace verlet_cable {

namespace {

/// Of what a joint stands for.
constexpr double touching = 0.2;

Eigen::Matrix3d about_x(double angle) {
  return Eigen::AngleAxisd(angle, Vector3::UnitX()).toRotationMatrix();
}

/// What has no length, where both nodes are held at one place, has a direction across its director all the same.
Vector3 direction(const Vector3& way, const Vector3& director) {
  if (!way.isZero(0)) return way.normalized();
  return director.isZero(0) ? Vector3(Vector3::UnitX()) : director.unitOrthogonal();
}

Vector3 direction(const CableState& state, int segment) {
  return direction(state.positions[segment + 1] - state.positions[segment], state.directors[segment]);
}

Eigen::Matrix3d frame_of(const Vector3& x, const Vector3& director) {
  Eigen::Matrix3d frame;
  frame.col(0) = x;
  frame.col(2) = x.cross(director).normalized();
  frame.col(1) = frame.col(2).cross(x);
  return frame;
}

/// Carried to another direction the shortest way, then turned about it [rad].
Eigen::Matrix3d carried(const Eigen::Matrix3d& frame, const Vector3& to, double twist) {
  return frame_of(to, parallel_transport(frame.col(1), frame.col(0), to)) * about_x(twist);
}

/// The length [m] of cable and the twist [rad] that a joint between a clamp and a segment beside it has.
double half_length(const CableState& state, int segment) {
  return 0.5 * state.rest_lengths[segment];
}

std::vector<DirectionTarget>::iterator clamp_at(int node, std::vector<DirectionTarget>& clamps) {
  return std::find_if(clamps.begin(), clamps.end(), [node](const DirectionTarget& clamp) { return clamp.node == node; });
}

/// The twist [rad] of the joints between a clamp and the segments before and after it: at the cable's ends the cable's own.
double& twist_before(DirectionTarget& clamp, CableState& state) {
  return clamp.node + 1 == static_cast<int>(state.joint_twist.size()) ? state.joint_twist.back() : clamp.twist_before;
}
double& twist_after(DirectionTarget& clamp, CableState& state) {
  return clamp.node == 0 ? state.joint_twist.front() : clamp.twist_after;
}

/// Turns a clamp about its direction so that it holds the material as it is.
void hold_roll(const Eigen::Matrix3d& material, DirectionTarget& clamp) {
  const Eigen::Matrix3d held = clamp.orientation.toRotationMatrix();
  turn_in_clamp(std::atan2(held.col(2).dot(material.col(1)), held.col(1).dot(material.col(1))), clamp);
}

/// Carries frames along the cable from a node on, `side` 1 towards the end and -1 towards the start.
void carry_from(int node, int side, Eigen::Matrix3d frame, bool clamped, std::vector<DirectionTarget>& clamps,
                CableState& state) {
  const auto go_on = [&](int at, double length, const Vector3& to) {
    const double twist = rest_angles(state, at, length).twist;
    frame = carried(frame, to, side * twist);
    return twist;
  };
  const int n = state.segments();
  for (int i = node; side > 0 ? i <= n : i >= 0; i += side) {
    const int before = side > 0 ? i - 1 : i, after = side > 0 ? i : i - 1;
    const auto clamp = clamp_at(i, clamps);
    const bool leaves = after >= 0 && after < n;
    if (clamp == clamps.end()) {
      if (!leaves) return;
      if (i != node) state.joint_twist[i] = go_on(i, joint_length(state, i), direction(state, after));
    } else {
      if (i != node || !clamped) {
        const double twist = go_on(i, half_length(state, before), clamp->orientation * Vector3::UnitX());
        (side > 0 ? twist_before(*clamp, state) : twist_after(*clamp, state)) = twist;
        hold_roll(frame, *clamp);
      }
      if (!leaves) return;
      const double twist = go_on(i, half_length(state, after), direction(state, after));
      (side > 0 ? twist_after(*clamp, state) : twist_before(*clamp, state)) = twist;
    }
    state.directors[after] = frame.col(1);
  }
}

}  // namespace

Eigen::Matrix3d segment_frame(const CableState& state, int segment) {
  return frame_of(direction(state, segment), state.directors[segment]);
}

double joint_length(const CableState& state, int node) {
  return (node > 0 ? half_length(state, node - 1) : 0) + (node < state.segments() ? half_length(state, node) : 0);
}

double material_twist(const CableModel& model, const CableState& state, int node) {
  const int n = state.segments();
  const bool is_end = node == 0 || node == n;
  if (is_end && CableMaterials(model, state)[std::min(node, n - 1)].torsional_stiffness == 0) return 0;
  return state.joint_twist[node];
}

JointAngles rest_angles(const CableState& state, int node, double length) {
  JointAngles angles;
  const double flexible = state.bending_length(node, length);
  if (!state.rest_twist.empty()) angles.twist = state.rest_twist[node] * flexible;
  if (state.rest_curvature.empty()) return angles;
  angles.y = state.rest_curvature[node][0] * flexible;
  angles.z = state.rest_curvature[node][1] * flexible;
  return angles;
}

Eigen::Matrix3d joint_rotation(const JointAngles& angles) {
  const Vector3 bend(0, angles.y, angles.z);
  const double angle = bend.norm();
  const Eigen::Matrix3d half = about_x(0.5 * angles.twist);
  if (angle == 0) return half * half;
  return half * Eigen::AngleAxisd(angle, bend / angle).toRotationMatrix() * half;
}

Eigen::Matrix3d node_frame(const CableState& state, int node) {
  const int n = state.segments();
  if (node > 0 && node < n) {
    const Vector3 sum = direction(state, node - 1) + direction(state, node);
    const Vector3 along = sum.norm() > 0 ? Vector3(sum.normalized()) : direction(state, node);
    return carried(segment_frame(state, node - 1), along, 0.5 * joint_angles_at(state, node).twist);
  }
  const int segment = node == 0 ? 0 : n - 1;
  const Eigen::Matrix3d to_node = joint_rotation(rest_angles(state, node, half_length(state, segment)));
  const Eigen::Matrix3d frame = segment_frame(state, segment);
  return node == 0 ? Eigen::Matrix3d(frame * to_node.transpose()) : Eigen::Matrix3d(frame * to_node);
}

Quaternion axes_at(const CableState& state, int node) {
  if (!state.directors.empty()) return Quaternion(node_frame(state, node));
  return segment_orientations(state)[std::min(node, state.segments() - 1)];
}

void start_frames(std::vector<DirectionTarget>& clamps, CableState& state) {
  const int n = state.segments();
  state.directors.assign(n, Vector3::Zero());
  state.spin.assign(n, 0.0);
  state.joint_twist.assign(n + 1, 0.0);
  if (clamps.empty()) {
    const Vector3 along = direction(state, 0);
    const Eigen::Matrix3d frame = smallest_rotation(Vector3::UnitX(), along).toRotationMatrix();
    carry_from(0, 1, frame_of(along, frame.col(1)), false, clamps, state);
    return;
  }
  const int first = clamps.front().node;
  const Eigen::Matrix3d frame = clamps.front().orientation.toRotationMatrix();
  carry_from(first, 1, frame, true, clamps, state);
  carry_from(first, -1, frame, true, clamps, state);
}

void give_frames(CableState& state, std::vector<DirectionTarget>& clamps) {
  if (!state.directors.empty()) return;
  const int n = state.segments();
  std::vector<Vector3> directors;
  for (const Quaternion& orientation : segment_orientations(state)) directors.push_back(orientation * Vector3::UnitY());
  state.directors = std::move(directors);
  state.spin.assign(n, 0.0);
  state.joint_twist.assign(n + 1, 0.0);
  const auto half_twist = [&](int segment) { return half_length(state, segment) * state.twist[segment]; };
  for (int i = 1; i < n; ++i) state.joint_twist[i] = half_twist(i - 1) + half_twist(i);
  for (DirectionTarget& clamp : clamps) {
    const int i = clamp.node;
    const int segment = i < n ? i : i - 1;
    const double turn = i < n ? -half_twist(segment) : half_twist(segment);
    hold_roll(carried(segment_frame(state, segment), clamp.orientation * Vector3::UnitX(), turn), clamp);
    if (i > 0) twist_before(clamp, state) = half_twist(i - 1);
    if (i < n) twist_after(clamp, state) = half_twist(i);
    if (i > 0 && i < n) state.joint_twist[i] = 0;
  }
  std::fill(state.twist.begin(), state.twist.end(), 0.0);
}

void drop_frames(CableState& state, std::vector<DirectionTarget>& clamps) {
  if (state.directors.empty()) return;
  for (std::size_t k = 0; k + 1 < clamps.size(); ++k) {
    const int first = clamps[k].node, last = clamps[k + 1].node;
    double twist = twist_after(clamps[k], state) + twist_before(clamps[k + 1], state);
    for (int i = first + 1; i < last; ++i) twist += state.joint_twist[i];
    std::fill(state.twist.begin() + first, state.twist.begin() + last, twist / state.length(first, last));
  }
  state.reference_node = clamps.empty() ? 0 : clamps.front().node;
  state.reference_orientation = clamps.empty() ? Quaternion(segment_frame(state, 0)) : clamps.front().orientation;
  for (DirectionTarget& clamp : clamps) clamp.twist_before = clamp.twist_after = 0;
  state.directors.clear();
  state.spin.clear();
  state.joint_twist.clear();
}

void weld_frames(int segment, CableState& state) {
  if (state.directors.empty()) return;
  const int after = segment + 1;
  // Ends that are close to each other have no direction between them.
  const Vector3 way = state.positions[after] - state.positions[segment];
  const Eigen::Matrix3d before = segment_frame(state, segment - 1);
  const bool apart = way.norm() > touching * joint_length(state, after);
  const Eigen::Matrix3d between = carried(before, apart ? Vector3(way.normalized()) : Vector3(before.col(0)), 0);
  state.directors[segment] = between.col(1);
  state.joint_twist[segment] = 0;
  state.joint_twist[after] = joint_angles(between, segment_frame(state, after), 0).twist;
  state.rest_twist.resize(state.nodes(), 0.0);
  state.rest_twist[segment] = 0;
  state.rest_twist[after] = state.joint_twist[after] / state.bending_length(after, joint_length(state, after));
}

Vector3 carried_director(const CableState& state, int segment, const Vector3& along, double angle) {
  return carried(segment_frame(state, segment), along.normalized(), angle).col(1);
}

void turn_segment(int segment, double angle, CableState& state) {
  state.directors[segment] = (segment_frame(state, segment) * about_x(angle)).col(1);
}

void turn_in_clamp(double angle, DirectionTarget& clamp) {
  clamp.roll = std::remainder(clamp.roll + angle, 2 * M_PI);
  const Quaternion about_direction(Eigen::AngleAxisd(angle, Vector3::UnitX()));
  clamp.orientation = clamp.orientation * about_direction;
  clamp.next_orientation = clamp.next_orientation * about_direction;
}

void carry_frames(const std::vector<Vector3>& before, CableState& state) {
  for (std::size_t i = 0; i < state.directors.size(); ++i) {
    const Vector3 from = direction(before[i + 1] - before[i], state.directors[i]), to = direction(state, static_cast<int>(i));
    state.directors[i] = frame_of(to, parallel_transport(state.directors[i], from, to)).col(1);
  }
}

JointAngles joint_angles_at(const CableState& state, int node) {
  return joint_angles(segment_frame(state, node - 1), segment_frame(state, node), state.joint_twist[node]);
}

void measure_joint_twists(std::vector<DirectionTarget>& clamps, CableState& state) {
  if (state.directors.empty()) return;
  const int n = state.segments();
  for (const int end : {0, n})
    if (clamp_at(end, clamps) == clamps.end()) state.joint_twist[end] = 0;
  for (int i = 1; i < n; ++i)
    if (clamp_at(i, clamps) == clamps.end()) state.joint_twist[i] = joint_angles_at(state, i).twist;
  for (DirectionTarget& clamp : clamps) {
    double& at_node = state.joint_twist[clamp.node];
    if (clamp.node == 0 || clamp.node == n) {
      if (at_node == 0) at_node = clamp.node == 0 ? clamp.twist_after : clamp.twist_before;
    } else {
      clamp.twist_before += 0.5 * at_node;
      clamp.twist_after += 0.5 * at_node;
      at_node = 0;
    }
    const Eigen::Matrix3d held = clamp.orientation.toRotationMatrix();
    if (clamp.node > 0) {
      double& twist = twist_before(clamp, state);
      twist = joint_angles(segment_frame(state, clamp.node - 1), held, twist).twist;
    }
    if (clamp.node < n) {
      double& twist = twist_after(clamp, state);
      twist = joint_angles(held, segment_frame(state, clamp.node), twist).twist;
    }
  }
}

void roll_clamps_to_twist(std::vector<DirectionTarget>& clamps, CableState& state) {
  if (state.directors.empty()) return;
  for (DirectionTarget& clamp : clamps) {
    const Eigen::Matrix3d held = clamp.orientation.toRotationMatrix();
    const bool has_before = clamp.node > 0, has_after = clamp.node < state.segments();
    double roll = 0;
    if (has_after) {
      double& twist = twist_after(clamp, state);
      const double measured = joint_angles(held, segment_frame(state, clamp.node), twist).twist;
      roll = measured - twist;
      if (&clamp == &clamps.front()) twist = measured;
    }
    if (has_before) {
      double& twist = twist_before(clamp, state);
      const double measured = joint_angles(segment_frame(state, clamp.node - 1), held, twist).twist;
      roll = twist - measured;
      if (&clamp == &clamps.front()) twist = measured;
    }
    if (&clamp != &clamps.front()) turn_in_clamp(roll, clamp);
  }
}

double take_excess_twist(std::vector<DirectionTarget>& clamps, const std::function<bool(const DirectionTarget&)>& may_turn,
                         CableState& state) {
  double largest = 0, excess = 0;
  for (std::size_t k = 0; k + 1 < clamps.size() && !state.directors.empty(); ++k) {
    DirectionTarget &first = clamps[k], &last = clamps[k + 1];
    excess += twist_after(first, state) - rest_angles(state, first.node, half_length(state, first.node)).twist +
              twist_before(last, state) - rest_angles(state, last.node, half_length(state, last.node - 1)).twist;
    for (int i = first.node + 1; i < last.node; ++i)
      excess += state.joint_twist[i] - rest_angles(state, i, joint_length(state, i)).twist;
    if (!may_turn(last)) continue;
    largest = std::max(largest, std::abs(excess));
    turn_in_clamp(-excess, last);
    twist_before(last, state) -= excess;
    if (last.node < state.segments()) twist_after(last, state) += excess;
    excess = 0;
  }
  return largest;
}

void release_joint_twist(const DirectionTarget& clamp, CableState& state) {
  if (state.joint_twist.empty()) return;
  const bool inside = clamp.node > 0 && clamp.node + 1 < static_cast<int>(state.joint_twist.size());
  state.joint_twist[clamp.node] = inside ? clamp.twist_before + clamp.twist_after : 0;
}

void take_end_twists(CableState& state, std::vector<DirectionTarget>& clamps) {
  if (state.joint_twist.empty()) return;
  for (DirectionTarget& clamp : clamps) {
    if (clamp.node == 0) clamp.twist_after = std::exchange(state.joint_twist.front(), 0);
    if (clamp.node + 1 == static_cast<int>(state.joint_twist.size()))
      clamp.twist_before = std::exchange(state.joint_twist.back(), 0);
  }
}

}  // namespace verlet_cable

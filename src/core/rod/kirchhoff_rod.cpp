#include "rod/kirchhoff_rod.h"

#include <algorithm>
#include <cmath>

#include "rod/bending_memory.h"
#include "rod/joint_material.h"
#include "rod/rod_frames.h"
#include "rod/substep.h"

namespace verlet_cable {

namespace {

/// In statics a twist increment meets at least this part of a joint's resistance: a rod between hinges may be free to spin, and what
/// has no torsional stiffness is everywhere. Where inertia alone were left, it would vanish in the rounding of long steps.
constexpr double least_static_resistance = 1e-7;

/// [N m^2] Of what has no torsional stiffness, that to bending: both are about the same in round sections.
double resistance_to_twist(const MaterialDesc& material) {
  return material.torsional_stiffness > 0 ? material.torsional_stiffness : material.bending_stiffness.smallest();
}

/// About the tangent, of a round section [kg m]
double section_inertia(const MaterialDesc& material) {
  return 0.5 * material.linear_density * material.radius * material.radius;
}

/// Calls visitor(direction, segment, whether the segment comes after the clamp) for every joint of a clamp.
template <class Visitor>
void visit_clamp_joints(const std::vector<HeldDirection>& directions, int segments, const Visitor& visitor) {
  for (std::size_t k = 0; k < directions.size(); ++k) {
    if (directions[k].node > 0) visitor(k, directions[k].node - 1, false);
    if (directions[k].node < segments) visitor(k, directions[k].node, true);
  }
}

double clamp_twist(const CableState& state, const HeldDirection& direction, int segments, bool after) {
  if (direction.node == 0 || direction.node == segments) return state.joint_twist[direction.node];
  return after ? direction.twist_after : direction.twist_before;
}

/// What the joint at a node between two segments has of their halves, and one between a clamp and a segment of its half.
HalfBend memory_at(const CableState& state, int node) {
  if (state.bending_memory.empty()) return {};
  return sum_of({{1, state.bending_memory[node - 1].back()}, {1, state.bending_memory[node].front()}});
}
HalfBend memory_beside_clamp(const CableState& state, int segment, bool after) {
  return state.bending_memory.empty() ? HalfBend{} : state.bending_memory[segment][after ? 0 : 1];
}

void add_slid(double share, const HalfBend& slid, HalfBend& half) {
  half = sum_of({{1, half}, {share, slid}});
}

HalfBend slid_of(const AboutAxes& yielded, const AboutAxes& slipped) {
  return {{yielded.y, yielded.z}, {slipped.y, slipped.z}};
}

/// By the lengths of the halves at a node between two segments.
void add_slid_at(int node, const HalfBend& slid, CableState& state) {
  const double before = state.rest_lengths[node - 1], part = before / (before + state.rest_lengths[node]);
  add_slid(part, slid, state.bending_memory[node - 1].back());
  add_slid(1 - part, slid, state.bending_memory[node].front());
}

/// Strands that stick to each other resist bending by so many times what they do when they slip.
constexpr double sticking = 10;

/// `around` [m]: the cable that the joint stands for.
JointStiffness joint_stiffness(const JointMaterial& material, const CableState& state, int node, double around,
                               double damping_time, const HalfBend& memory) {
  const double length = state.bending_length(node, around), per_length = 1 / length;
  JointStiffness stiffness;
  stiffness.twist = material.torsional_stiffness * per_length;
  stiffness.bend_y = material.bending_stiffness[0] * per_length;
  stiffness.bend_z = material.bending_stiffness[1] * per_length;
  stiffness.twist_damping = material.torsional_damping / damping_time * per_length;
  stiffness.bend_damping = material.bending_damping / damping_time * per_length;
  stiffness.rest = rest_angles(state, node, around);
  if (state.bending_memory.empty()) return stiffness;
  const double yields = 1 - material.hardening;
  stiffness.yielding = {yields * stiffness.bend_y,
                        yields * stiffness.bend_z,
                        material.yield_curvature * length,
                        {memory.yielded[0], memory.yielded[1]}};
  const double stuck = sticking * material.bending_stiffness.smallest();
  if (material.bending_friction > 0 && stuck > 0)
    stiffness.friction = {stuck * per_length,
                          stuck * per_length,
                          material.bending_friction / stuck * length,
                          {memory.slipped[0], memory.slipped[1]}};
  return stiffness;
}

/// A wheel gives the cable its shape: no bending moment leaves it.
void let_bend(JointStiffness& stiffness) {
  stiffness.bend_y = stiffness.bend_z = stiffness.bend_damping = 0;
  stiffness.yielding = stiffness.friction = {};
}

/// How much of the way of a flow from segment `before` to segment `after` the joint at a node gains.
double share_of_flow(int before, int after, int node) {
  return 0.5 * ((node == after || node == after + 1) - (node == before || node == before + 1));
}

/// [N] By what the energy of a joint grows with the length that it stands for, from `start` to `end` [m]; `stiffness` is that at
/// the start.
double energy_slope(const JointStiffness& stiffness, const JointAngles& angles, double start, double end) {
  const auto slope = [&](double resistance, double angle, double rest) {
    const double scale = end / start, strained = angle - scale * rest;
    return -0.5 * resistance / end * strained * (strained + 2 * scale * rest);
  };
  const auto bent = [&](double y_resistance, double z_resistance, const AboutAxes& angle) {
    return slope(y_resistance, angle.y, stiffness.rest.y) + slope(z_resistance, angle.z, stiffness.rest.z);
  };
  const AboutAxes angle{angles.y, angles.z};
  const SlidingSpring &yielding = stiffness.yielding, &friction = stiffness.friction;
  /// What bends a spring, and is at rest with it, once that has slid.
  const auto bend_of = [&](const SlidingSpring& spring) {
    return AboutAxes{stiffness.rest.y, stiffness.rest.z} + spring.slide(strain_of(spring, stiffness.rest, angles)).strain;
  };
  return slope(stiffness.twist, angles.twist, stiffness.rest.twist) +
         bent(stiffness.bend_y - yielding.y_stiffness, stiffness.bend_z - yielding.z_stiffness, angle) +
         bent(yielding.y_stiffness, yielding.z_stiffness, bend_of(yielding)) +
         bent(friction.y_stiffness, friction.z_stiffness, bend_of(friction));
}

/// Calls visitor(stiffness, angles, node, segment, whether the segment comes after the clamp) for every joint of a whole rod,
/// which is between two segments where `segment` is negative.
template <class Visitor>
void visit_rod_joints(const CableModel& model, const CableState& state, const std::vector<HeldDirection>& directions,
                      const Visitor& visitor) {
  const int n = state.segments();
  const CableMaterials materials(model, state);
  for (int i = 1; i < n; ++i) {
    if (std::any_of(directions.begin(), directions.end(), [i](const HeldDirection& d) { return d.node == i; })) continue;
    visitor(joint_stiffness(joint_material(materials, state, i), state, i, joint_length(state, i), infinity, memory_at(state, i)),
            joint_angles_at(state, i), i, -1, false);
  }
  visit_clamp_joints(directions, n, [&](std::size_t target, int segment, bool after) {
    const HeldDirection& held = directions[target];
    const double twist = clamp_twist(state, held, n, after);
    const Eigen::Matrix3d beside = segment_frame(state, segment), clamp = held.end.toRotationMatrix();
    visitor(joint_stiffness(JointMaterial(materials[segment]), state, held.node, 0.5 * state.rest_lengths[segment], infinity,
                            memory_beside_clamp(state, segment, after)),
            after ? joint_angles(clamp, beside, twist) : joint_angles(beside, clamp, twist), held.node, segment, after);
  });
}

}  // namespace

void KirchhoffRod::resize(int segments) {
  segments_ = segments;
  const std::size_t nodes = segments_ + 2;
  for (std::vector<double>* a : {&inertia_, &spin_, &tau_}) a->assign(nodes, 0.0);
  frames_.resize(nodes);
  net_moment_.assign(nodes, 0.0);
  joints_.resize(segments_ + 1);
  clamps_.clear();
  changing_.reserve(segments_ + 1);
  stiffness_.resize(segments_);
  elimination_.resize(segments_);
}

void KirchhoffRod::start(const CableModel& model, const CableState& state, const VectorArray& segment, const Boundary& boundary,
                         double h, double damping_time, double part) {
  active_ = true;
  elastic_ = CableMaterials(model, state).any_elastic();
  simplified_ = false;
  slides_ = !state.bending_memory.empty();
  joints_.let_slide(slides_, damping_time == infinity);
  clamp_joints_.let_slide(slides_, damping_time == infinity);
  h_ = h;
  part_ = part;
  is_static_ = damping_time == infinity;
  spin_rate_ = part == 1 ? 1 : 2;
  start_segments(model, state, segment);
  start_joints(model, state, boundary, damping_time);
  start_clamps(model, state, boundary.directions, damping_time);
}

void KirchhoffRod::start_segments(const CableModel& model, const CableState& state, const VectorArray& segment) {
  const CableMaterials materials(model, state);
  double moment = section_inertia(model.material);
  for (int i = 0; i < segments_; ++i) {
    const Vector3& director = state.directors[i];
    set(frames_.start.y, i, director);
    if (materials.vary()) moment = section_inertia(materials[i]);
    inertia_[i] = moment * state.rest_lengths[i];
    if (is_static_)
      inertia_[i] =
          std::max(inertia_[i], h_ * h_ * least_static_resistance * resistance_to_twist(materials[i]) / state.rest_lengths[i]);
    spin_[i] = is_static_ ? 0 : state.spin[i];
    tau_[i] = h_ * spin_[i];
  }
  for (int i = 0; i < segments_; i += 2) {
    const PairVector d = neighbours(segment, i), y = neighbours(frames_.start.y, i);
    PairFrame frame;
    frame.x = (1.0 / square_root(dot(d, d))) * d;
    frame.y = y - dot(y, frame.x) * frame.x;
    frame.y = (1.0 / square_root(dot(frame.y, frame.y))) * frame.y;
    frame.z = cross(frame.x, frame.y);
    put(frame, frames_.start, i);
  }
  set(frames_.start, segments_, get(frames_.start, segments_ - 1));
}

void KirchhoffRod::start_joints(const CableModel& model, const CableState& state, const Boundary& boundary, double damping_time) {
  const int n = segments_;
  const CableMaterials materials(model, state);
  JointMaterial material(model.material);
  changing_.clear();
  for (int i = 1; i < n; ++i) {
    if (materials.vary() || slides_) material = joint_material(materials, state, i);
    const double length = joint_length(state, i);
    JointStiffness stiffness = joint_stiffness(material, state, i, length, damping_time, memory_at(state, i));
    for (const GuidedFlow& flow : boundary.flows)
      if (flow.first != flow.last && (i == flow.first || i == flow.last)) let_bend(stiffness);
    joints_.set(i, stiffness, state.joint_twist[i]);
    for (const GuidedFlow& flow : boundary.flows)
      if (flow.first - 1 <= i && i <= flow.last + 1 && (changing_.empty() || changing_.back().node != i))
        changing_.push_back({i, length, length, stiffness, 0, {}, {}});
  }
  for (const GuidedFlow& flow : boundary.flows)
    for (ChangingJoint& joint : changing_)
      if (slides_) find_brought(flow, state, joint);
  for (const HeldDirection& direction : boundary.directions) {
    if (direction.node <= 0 || direction.node >= n) continue;
    joints_.set(direction.node, {}, 0);
    for (ChangingJoint& joint : changing_)
      if (joint.node == direction.node) joint.stiffness = {};
  }
  joints_.start(frames_.start, 0, frames_.start, 1, 1, n);
  if (!slides_) return;
  for (ChangingJoint& joint : changing_) {
    joint.stiffness.yielding.slid = joints_.start_yielded(joint.node);
    joint.stiffness.friction.slid = joints_.start_slipped(joint.node);
  }
}

/// Over the middles of the segments beside a guide; at its wheel no bending moment resists.
void KirchhoffRod::find_brought(const GuidedFlow& flow, const CableState& state, ChangingJoint& joint) {
  const int before = flow.first - 1, after = flow.last;
  for (const double way : {-1.0, 1.0}) {
    HalfBend& brought = way > 0 ? joint.forward : joint.backward;
    const auto add = [&](double share, int segment) { add_slid(share, bends_at_border(2 * segment + 1, way, state), brought); };
    if (joint.node == before) add(-0.5, before);
    if (joint.node == before + 1) add(0.5, before);
    if (joint.node == after) add(-0.5, after);
    if (joint.node == after + 1) add(0.5, after);
  }
}

void KirchhoffRod::start_clamps(const CableModel& model, const CableState& state, const std::vector<HeldDirection>& directions,
                                double damping_time) {
  const CableMaterials materials(model, state);
  std::size_t count = 0;
  visit_clamp_joints(directions, segments_, [&](std::size_t, int, bool) { ++count; });
  if (clamp_before_.start.x.x.size() < count + 2) {
    clamp_before_.resize(count + 2);
    clamp_after_.resize(count + 2);
    clamp_joints_.resize(static_cast<int>(count) + 1);
  }
  clamps_.clear();
  visit_clamp_joints(directions, segments_, [&](std::size_t target, int segment, bool after) {
    const HeldDirection& held = directions[target];
    const int joint = static_cast<int>(clamps_.size());
    clamps_.push_back({static_cast<int>(target), segment, after});
    const Eigen::Matrix3d start = held.start.toRotationMatrix(), end = held.end.toRotationMatrix();
    FrameMotion& of_clamp = after ? clamp_before_ : clamp_after_;
    FrameMotion& of_segment = after ? clamp_after_ : clamp_before_;
    set(of_clamp.start, joint, start);
    set(of_clamp.end, joint, end);
    set(of_clamp.middle, joint, start + part_ * (end - start));
    set(of_segment.start, joint, get(frames_.start, segment));
    clamp_joints_.set(joint,
                      joint_stiffness(JointMaterial(materials[segment]), state, held.node, 0.5 * state.rest_lengths[segment],
                                      damping_time, memory_beside_clamp(state, segment, after)),
                      clamp_twist(state, held, segments_, after));
  });
  clamp_joints_.start(clamp_before_.start, 0, clamp_after_.start, 0, 0, static_cast<int>(count));
}

void KirchhoffRod::follow_clamps(const Boundary& boundary) {
  for (std::size_t k = 0; k < clamps_.size(); ++k) {
    const int joint = static_cast<int>(k);
    FrameMotion& of_clamp = clamps_[k].after ? clamp_before_ : clamp_after_;
    const Eigen::Matrix3d start = get(of_clamp.start, joint);
    const Eigen::Matrix3d end = boundary.directions[clamps_[k].target].end.toRotationMatrix();
    set(of_clamp.end, joint, end);
    set(of_clamp.middle, joint, start + part_ * (end - start));
  }
}

void KirchhoffRod::forget_flows() {
  for (ChangingJoint& joint : changing_) {
    joint.end = joint.start;
    joint.way = 0;
    if (slides_) joints_.bring(joint.node, {}, {});
  }
}

void KirchhoffRod::add_flow(int before, int after, double way) {
  for (ChangingJoint& joint : changing_) {
    const double share = share_of_flow(before, after, joint.node);
    if (before <= joint.node && joint.node <= after + 1) {
      joint.way = way;
      const HalfBend brought = sum_of({{way, brought_to(joint)}});
      if (slides_) joints_.bring(joint.node, {brought.yielded[0], brought.yielded[1]}, {brought.slipped[0], brought.slipped[1]});
    }
    if (share == 0) continue;
    joint.end += share * way;
    const double scale = part_ == 1 ? joint.start / joint.end : 0.5 * (1 + joint.start / joint.end);
    JointStiffness stiffness = joint.stiffness;
    SlidingSpring &yielding = stiffness.yielding, &friction = stiffness.friction;
    for (double* value : {&stiffness.twist, &stiffness.bend_y, &stiffness.bend_z, &yielding.y_stiffness, &yielding.z_stiffness,
                          &friction.y_stiffness, &friction.z_stiffness})
      *value *= scale;
    for (double* value : {&stiffness.rest.twist, &stiffness.rest.y, &stiffness.rest.z, &yielding.limit, &friction.limit})
      *value /= scale;
    joints_.set_stiffness(joint.node, stiffness);
  }
}

/// With what has been brought, but of the start otherwise.
JointStiffness KirchhoffRod::stiffness_at_end(const ChangingJoint& joint) {
  const HalfBend brought = sum_of({{joint.way, brought_to(joint)}});
  JointStiffness stiffness = joint.stiffness;
  stiffness.yielding.slid = stiffness.yielding.slid + AboutAxes{brought.yielded[0], brought.yielded[1]};
  stiffness.friction.slid = stiffness.friction.slid + AboutAxes{brought.slipped[0], brought.slipped[1]};
  return stiffness;
}

double KirchhoffRod::flow_force(int before, int after) const {
  double force = 0;
  for (const ChangingJoint& joint : changing_) {
    if (slides_ && before <= joint.node && joint.node <= after + 1) force += force_of_brought(joint);
    const double share = share_of_flow(before, after, joint.node);
    if (share == 0) continue;
    const int i = joint.node;
    const double start_twist = joints_.start_twist(i);
    const JointAngles end = joint_angles(get(frames_.end, i - 1), get(frames_.end, i), start_twist);
    const double at_end = energy_slope(stiffness_at_end(joint), end, joint.start, joint.end);
    if (part_ == 1) {
      force -= share * at_end;
      continue;
    }
    const JointAngles start = joint_angles(get(frames_.start, i - 1), get(frames_.start, i), start_twist);
    force -= share * 0.5 * (energy_slope(joint.stiffness, start, joint.start, joint.end) + at_end);
  }
  return force;
}

/// [N] With which what a joint remembers drives a flow that takes it along.
double KirchhoffRod::force_of_brought(const ChangingJoint& joint) const {
  const int i = joint.node;
  const HalfBend brought = joint.way == 0 ? sum_of({{0.5, joint.backward}, {0.5, joint.forward}}) : brought_to(joint);
  const JointStiffness at_end = stiffness_at_end(joint);
  const JointAngles start = joint_angles(get(frames_.start, i - 1), get(frames_.start, i), joints_.start_twist(i));
  const JointAngles end = joint_angles(get(frames_.end, i - 1), get(frames_.end, i), joints_.start_twist(i));
  const auto force = [&](const SlidingSpring& spring, const SlidingSpring& at_end, const std::array<double, 2>& slid) {
    const AboutAxes before = strain_of(spring, joint.stiffness.rest, start);
    const AboutAxes after = at_end.slide(strain_of(at_end, joint.stiffness.rest, end)).strain;
    return dot(spring.moment(before + part_ * (after - before)), {slid[0], slid[1]});
  };
  return force(joint.stiffness.yielding, at_end.yielding, brought.yielded) +
         force(joint.stiffness.friction, at_end.friction, brought.slipped);
}

/// The frames at the end of the present iterate.
void KirchhoffRod::turn_frames(const VectorArray& displacement, const VectorArray& segment) {
  for (int i = 0; i < segments_; i += 2) {
    const PairFrame start = neighbours(frames_.start, i);
    const PairVector d = neighbours(segment, i) + (neighbours(displacement, i + 1) - neighbours(displacement, i));
    PairFrame end;
    end.x = (1.0 / square_root(dot(d, d))) * d;
    const PairVector mean = both(0.5) * (start.x + end.x);
    const PairVector turn = (1.0 / dot(mean, mean)) * cross(start.x, end.x) + neighbours(tau_, i) * mean;
    const PairVector once = cross(turn, start.y);
    end.y = start.y + (1.0 / (1.0 + 0.25 * dot(turn, turn))) * (once + both(0.5) * cross(turn, once));
    end.z = cross(end.x, end.y);
    put(end, frames_.end, i);
    PairFrame middle = end;
    if (part_ != 1) middle = {mean, both(0.5) * (start.y + end.y), both(0.5) * (start.z + end.z)};
    put(middle, frames_.middle, i);
  }
  set(frames_.end, segments_, get(frames_.end, segments_ - 1));
  set(frames_.middle, segments_, get(frames_.middle, segments_ - 1));
}

/// Copies the frames of segments to where their clamps' joints are.
void KirchhoffRod::set_clamp_frames() {
  for (std::size_t k = 0; k < clamps_.size(); ++k) {
    FrameMotion& beside = clamps_[k].after ? clamp_after_ : clamp_before_;
    set(beside.end, static_cast<int>(k), get(frames_.end, clamps_[k].segment));
    set(beside.middle, static_cast<int>(k), get(frames_.middle, clamps_[k].segment));
  }
}

void KirchhoffRod::add_segment_forces(const VectorArray& displacement, const VectorArray& segment, const VectorArray& middle,
                                      VectorArray& segment_force) {
  turn_frames(displacement, segment);
  joints_.evaluate(part_, frames_, 0, frames_, 1, 1, segments_);
  set_clamp_frames();
  clamp_joints_.evaluate(part_, clamp_before_, 0, clamp_after_, 0, 0, static_cast<int>(clamps_.size()));

  for (int i = 0; i < segments_; i += 2) put(neighbours(joints_.moment, i + 1) - neighbours(joints_.moment, i), net_moment_, i);
  for (std::size_t k = 0; k < clamps_.size(); ++k) {
    const ClampJoint& clamp = clamps_[k];
    const Vector3 moment = get(clamp_joints_.moment, static_cast<int>(k));
    set(net_moment_, clamp.segment, get(net_moment_, clamp.segment) + (clamp.after ? -moment : moment));
  }
  const Pair inverse_h = both(1 / h_), spin_rate = both(spin_rate_);
  for (int i = 0; i < segments_; i += 2) {
    const PairVector start = neighbours(frames_.start.x, i), end = neighbours(frames_.end.x, i), d = neighbours(middle, i);
    const PairVector moment = neighbours(net_moment_, i);
    const Pair spin = neighbours(spin_, i), tau = neighbours(tau_, i);
    const Pair mean_square = 0.5 * (1.0 + dot(start, end));
    const Pair end_spin = spin + spin_rate * (inverse_h * tau * mean_square - spin);
    const PairVector unbalanced = moment - (inverse_h * neighbours(inertia_, i)) * (end_spin * end - spin * start);
    const Pair inverse_square = 1.0 / dot(d, d);
    put(square_root(inverse_square) * dot(unbalanced, d), stiffness_.torque, i);
    PairVector force = inverse_square * cross(d, unbalanced);
    if (elastic_ && part_ != 1) {
      // Keeps the energy where the segment's length changes.
      const PairVector change = neighbours(displacement, i + 1) - neighbours(displacement, i), before = neighbours(segment, i);
      const PairVector after = before + change;
      const Pair length = square_root(dot(before, before)), end_length = square_root(dot(after, after));
      const Pair work = dot(moment, cross(start, end)) * (end_length - length) * inverse_square / (4.0 * mean_square) -
                        tau * dot(moment, change) / (4.0 * length * end_length);
      force = force - (2.0 / (length + end_length) * work) * d;
    }
    for (int lane = 0; lane < 2 && i + lane < segments_; ++lane) {
      segment_force.x[i + lane] += force.x[lane];
      segment_force.y[i + lane] += force.y[lane];
      segment_force.z[i + lane] += force.z[lane];
    }
  }
  stiffness_.torque[segments_] = 0;
}

void KirchhoffRod::assemble(const VectorArray& middle, const std::vector<double>& density) {
  for (int i = 0; i < segments_; ++i) stiffness_.force_density[i] = part_ * density[i];
  set_stiffness(middle, simplified_);
}

void KirchhoffRod::factor(const KktSystem& system) {
  if (elimination_.factor(system, stiffness_, joints_) || simplified_) return;
  set_stiffness(system.direction, true);
  elimination_.factor(system, stiffness_, joints_);
}

/// By what a clamp that turns adds to the moment on the segment beside it; see RodElimination for what turns with the frames.
Vector3 KirchhoffRod::turned_by_clamp(const ClampJoint& clamp, int joint, const Vector3& rotation) const {
  const Vector3 moment = stiffness_.turning_part * get(clamp_joints_.moment, joint);
  return get(clamp_joints_.stiffness(), joint) * rotation + (clamp.after ? 1 : -1) * moment.cross(rotation);
}

void KirchhoffRod::add_clamp_loads(const std::vector<Vector3>& rotations, KktSystem& system) {
  for (std::size_t k = 0; k < clamps_.size(); ++k) {
    ClampJoint& clamp = clamps_[k];
    const int i = clamp.segment;
    clamp.rotation = rotations[clamp.target];
    if (clamp.rotation.isZero(0)) continue;
    const Vector3 moment = turned_by_clamp(clamp, static_cast<int>(k), clamp.rotation);
    const Vector3 direction = get(system.direction, i);
    const Vector3 force = direction.cross(moment) / direction.squaredNorm();
    set(system.load, i, get(system.load, i) + force);
    set(system.load, i + 1, get(system.load, i + 1) - force);
    stiffness_.torque[i] += moment.dot(direction.normalized());
  }
}

void KirchhoffRod::add_clamp_reactions(const KktSystem& system, std::vector<Vector3>& torques) const {
  const VectorArray& displacement = elimination_.displacement();
  for (std::size_t k = 0; k < clamps_.size(); ++k) {
    const ClampJoint& clamp = clamps_[k];
    const int i = clamp.segment, joint = static_cast<int>(k);
    const Vector3 direction = get(system.direction, i), change = get(displacement, i + 1) - get(displacement, i);
    const Vector3 turn = direction.cross(change) / direction.squaredNorm() + elimination_.twist()[i] * direction.normalized();
    const Vector3 clamp_turn = system.moves_held ? clamp.rotation : Vector3(Vector3::Zero());
    const Vector3 moment = stiffness_.turning_part * get(clamp_joints_.moment, joint);
    torques[clamp.target] +=
        get(clamp_joints_.stiffness(), joint) * (turn - clamp_turn) + (clamp.after ? -1 : 1) * moment.cross(turn);
  }
}

void KirchhoffRod::add_clamp_torques(std::vector<Vector3>& torques) const {
  for (std::size_t k = 0; k < clamps_.size(); ++k)
    torques[clamps_[k].target] += (clamps_[k].after ? 1 : -1) * get(clamp_joints_.moment, static_cast<int>(k));
}

double KirchhoffRod::correct(double part) {
  double largest = 0;
  for (int i = 0; i < segments_; ++i) {
    const double change = part * elimination_.twist()[i];
    tau_[i] += change;
    largest = larger(largest, std::abs(change));
  }
  return largest;
}

void KirchhoffRod::finish(const VectorArray& displacement, const VectorArray& segment, Boundary& boundary) {
  turn_frames(displacement, segment);
  set_clamp_frames();
  joints_.evaluate(part_, frames_, 0, frames_, 1, 1, segments_);
  clamp_joints_.evaluate(part_, clamp_before_, 0, clamp_after_, 0, 0, static_cast<int>(clamps_.size()));
  for (std::size_t k = 0; k < clamps_.size(); ++k) {
    const ClampJoint& clamp = clamps_[k];
    HeldDirection& target = boundary.directions[clamp.target];
    const Vector3 moment = get(clamp_joints_.moment, static_cast<int>(k));
    target.torque += clamp.after ? moment : Vector3(-moment);
    (clamp.after ? target.twist_after : target.twist_before) = clamp_joints_.end_twist(static_cast<int>(k));
  }
}

void KirchhoffRod::add_losses(EnergyBalance& balance) const {
  const auto add = [&](const RodJoints& joints, int first, int last) {
    for (int i = first; i < last; ++i) {
      balance.dissipated.bending += joints.bending_loss[i];
      balance.dissipated.torsional += joints.twisting_loss[i];
      if (slides_) balance.dissipated.yielding += joints.sliding_loss[i];
    }
  };
  add(joints_, 1, segments_);
  add(clamp_joints_, 0, static_cast<int>(clamps_.size()));
}

void KirchhoffRod::store(const Boundary& boundary, CableState& state) const {
  for (int i = 0; i < segments_; ++i) {
    state.directors[i] = get(frames_.end.y, i);
    const double mean_square = 0.5 * (1 + get(frames_.start.x, i).dot(get(frames_.end.x, i)));
    state.spin[i] = is_static_ ? 0 : spin_[i] + spin_rate_ * (tau_[i] * mean_square / h_ - spin_[i]);
    if (i > 0) state.joint_twist[i] = joints_.end_twist(i);
  }
  for (const HeldDirection& direction : boundary.directions) {
    const bool at_end = direction.node == segments_;
    state.joint_twist[direction.node] = at_end ? direction.twist_before : direction.node == 0 ? direction.twist_after : 0;
  }
  // On its way to an equilibrium nothing yields for good: the way is one of the solver's, not of the cable.
  if (slides_ && !is_static_) store_memory(state);
}

void KirchhoffRod::store_memory(CableState& state) const {
  for (int i = 1; i < segments_; ++i) add_slid_at(i, slid_of(joints_.yielded(i), joints_.slipped(i)), state);
  for (std::size_t k = 0; k < clamps_.size(); ++k) {
    const int joint = static_cast<int>(k);
    HalfBend& half = state.bending_memory[clamps_[k].segment][clamps_[k].after ? 0 : 1];
    add_slid(1, slid_of(clamp_joints_.yielded(joint), clamp_joints_.slipped(joint)), half);
  }
}

double KirchhoffRod::calm_spin(CableState& state) const {
  double taken = 0;
  for (int i = 0; i < segments_; ++i) {
    const double mean = 0.5 * (spin_[i] + state.spin[i]);
    if (!(std::abs(mean) < std::abs(state.spin[i]))) continue;
    taken += 0.5 * inertia_[i] * (state.spin[i] * state.spin[i] - mean * mean);
    state.spin[i] = mean;
  }
  return taken;
}

/// `simple`: without what may be negative (Gauss and Newton's).
void KirchhoffRod::set_stiffness(const VectorArray& direction, bool simple) {
  stiffness_.turning_part = simple ? 0 : 0.5 * part_;
  // Of means over a substep the exact one is no derivative.
  const bool exact = !simple && part_ == 1;
  joints_.set_exact(exact);
  clamp_joints_.set_exact(exact);
  const Pair turns = both(stiffness_.turning_part), spins = both(spin_rate_ / (h_ * h_));
  for (int i = 0; i < segments_; i += 2) {
    const PairVector d = neighbours(direction, i);
    const Pair square = dot(d, d);
    const PairVector axis = square_root(1.0 / square) * d;
    Pair pull = neighbours(stiffness_.force_density, i);
    if (simple) pull = Pair{std::max(pull[0], 0.0), std::max(pull[1], 0.0)};
    pull *= square;
    const PairVector across = turns * cross(axis, neighbours(net_moment_, i));
    // pull (1 - axis axis^T) + spins J axis axis^T - across axis^T - axis across^T
    const PairVector along = (spins * neighbours(inertia_, i) - pull) * axis - across;
    put({pull + along.x * axis.x - axis.x * across.x, along.x * axis.y - axis.x * across.y, along.x * axis.z - axis.x * across.z,
         pull + along.y * axis.y - axis.y * across.y, along.y * axis.z - axis.y * across.z,
         pull + along.z * axis.z - axis.z * across.z},
        stiffness_.segment, i);
  }
  for (std::size_t k = 0; k < clamps_.size(); ++k)
    add(stiffness_.segment, clamps_[k].segment, 1, get(clamp_joints_.stiffness(), static_cast<int>(k)));
  if (segments_ % 2 == 1) {
    // Of the segment that makes them even
    for (auto* diagonal : {&stiffness_.segment.xx, &stiffness_.segment.yy, &stiffness_.segment.zz}) (*diagonal)[segments_] = 1;
    for (auto* other : {&stiffness_.segment.xy, &stiffness_.segment.xz, &stiffness_.segment.yz}) (*other)[segments_] = 0;
  }
}

RodEnergy rod_energy(const CableModel& model, const CableState& state, const std::vector<HeldDirection>& directions,
                     const std::vector<int>& shaped) {
  const CableMaterials materials(model, state);
  RodEnergy sum;
  visit_rod_joints(model, state, directions,
                   [&](const JointStiffness& stiffness, const JointAngles& angles, int node, int segment, bool) {
                     const JointEnergy energy = joint_energy(stiffness, angles);
                     const bool bends = segment >= 0 || std::find(shaped.begin(), shaped.end(), node) == shaped.end();
                     if (bends) sum.bend += energy.bend;
                     sum.twist += energy.twist;
                   });
  for (int i = 0; i < state.segments(); ++i)
    sum.spin += 0.5 * section_inertia(materials[i]) * state.rest_lengths[i] * state.spin[i] * state.spin[i];
  return sum;
}

void yield_to_shape(const CableModel& model, const std::vector<HeldDirection>& directions, const std::vector<int>& shaped,
                    CableState& state) {
  if (state.bending_memory.empty() || state.directors.empty()) return;
  visit_rod_joints(model, state, directions,
                   [&](const JointStiffness& stiffness, const JointAngles& angles, int node, int segment, bool after) {
                     if (segment < 0 && std::find(shaped.begin(), shaped.end(), node) != shaped.end()) return;
                     const auto slid = [&](const SlidingSpring& spring) {
                       const AboutAxes strain = strain_of(spring, stiffness.rest, angles);
                       return strain - spring.slide(strain).strain;
                     };
                     const HalfBend more = slid_of(slid(stiffness.yielding), slid(stiffness.friction));
                     if (segment < 0)
                       add_slid_at(node, more, state);
                     else
                       add_slid(1, more, state.bending_memory[segment][after ? 0 : 1]);
                   });
}

std::vector<double> plastic_curvature(const SimulatedCable& cable) {
  const CableState& state = cable.state;
  const CableMaterials materials(cable);
  std::vector<double> curvature;
  if (state.bending_memory.empty() ||
      !materials.any([](const MaterialDesc& m) { return m.yield_curvature < infinity && m.hardening < 1; }))
    return curvature;
  for (int i = 1; i < state.segments(); ++i) {
    const auto [y, z] = memory_at(state, i).yielded;
    const double length = state.bending_length(i, joint_length(state, i));
    curvature.push_back((1 - joint_material(materials, state, i).hardening) * std::hypot(y, z) / length);
  }
  return curvature;
}

}  // namespace verlet_cable

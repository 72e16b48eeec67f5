#include "rod/bending.h"

#include <algorithm>

#include "geometry/eigen_vectors.h"
#include "rod/joint_material.h"

namespace verlet_cable {

void Bending::resize(int segments) {
  segments_ = segments;
  const std::size_t nodes = segments + 2;  // one more, where two are computed with together
  for (std::vector<double>* a : {&inverse_length_, &stiffness_, &damping_, &start_square_, &slope_}) a->assign(nodes, 0.0);
  for (VectorArray* a : {&start_, &change_, &moment_, &turn_, &driven_, &turned_}) a->assign(nodes, 0.0);
  spin_.resize(segments);
  clamps_.reserve(2 * nodes);
  segment_.assign(nodes, 0.0);
  rest_lengths_.assign(nodes, 0.0);
  growing_.reserve(nodes);
  changing_.reserve(2 * nodes);
}

void Bending::start(const CableModel& model, const CableState& state, const VectorArray& segment,
                    const std::vector<HeldDirection>& directions, double h, double part) {
  const CableMaterials materials(model, state);
  const bool damps = materials.any([](const MaterialDesc& material) { return material.bending_damping > 0; });
  active_ = state.directors.empty() && (damps || materials.any_bends());
  if (!active_) return;
  is_damped_ = damps && h < infinity;
  part_ = part;
  double stiffness = model.material.bending_stiffness.largest(), damping = model.material.bending_damping / h;
  for (int i = 0; i < segments_; ++i) inverse_length_[i] = 1 / state.rest_lengths[i];
  for (int i = 1; i < segments_; ++i) {
    const double joint = 1 / state.bending_length(i, 0.5 * (state.rest_lengths[i - 1] + state.rest_lengths[i]));
    if (materials.vary()) {
      const JointMaterial material = joint_material(materials, state, i);
      stiffness = material.bending_stiffness.largest();
      damping = material.bending_damping / h;
    }
    stiffness_[i] = stiffness * joint;
    damping_[i] = damping * joint;
    const Vector3 e = inverse_length_[i] * get(segment, i) - inverse_length_[i - 1] * get(segment, i - 1);
    set(start_, i, e);
    start_square_[i] = e.squaredNorm();
  }
  for (const HeldDirection& target : directions) stiffness_[target.node] = damping_[target.node] = 0;
  find_clamp_joints(
      model, state, directions, [&segment](int i) { return get(segment, i); }, h, part, clamps_);
  growing_.clear();
  changing_.clear();
  if (is_damped_) turn_with_material(model, state, segment, directions, h);
}

void Bending::start_flows(const CableState& state, const VectorArray& segment, const std::vector<GuidedFlow>& flows) {
  if (!active_) return;
  segment_ = segment;
  for (int i = 0; i < segments_; ++i) rest_lengths_[i] = state.rest_lengths[i];
  // A wheel gives the cable its shape: no moment leaves it.
  for (const GuidedFlow& flow : flows)
    if (flow.first != flow.last)
      for (const int node : {flow.first, flow.last}) stiffness_[node] = damping_[node] = 0;
}

void Bending::forget_flows() {
  for (GrowingSegment& growing : growing_) growing.end = growing.start;
}

void Bending::add_flow(int before, int after, double way) {
  if (!active_) return;
  grow(before, -way);
  grow(after, way);
  for (const int segment : {before, after})
    for (const int node : {segment, segment + 1})
      if (node > 0 && node < segments_) set_changing(node);
}

void Bending::grow(int segment, double growth) {
  auto growing = std::find_if(growing_.begin(), growing_.end(), [&](const GrowingSegment& g) { return g.segment == segment; });
  if (growing == growing_.end())
    growing = growing_.insert(growing_.end(), {segment, rest_lengths_[segment], rest_lengths_[segment]});
  growing->end += growth;
  const double start = 1 / growing->start;
  inverse_length_[segment] = start + part_ * (1 / growing->end - start);
}

void Bending::set_changing(int node) {
  auto changing = std::find_if(changing_.begin(), changing_.end(), [&](const ChangingJoint& c) { return c.node == node; });
  const double start_length = 0.5 * (rest_lengths_[node - 1] + rest_lengths_[node]);
  if (changing == changing_.end())
    changing = changing_.insert(changing_.end(), {node, stiffness_[node], stiffness_[node], start_length});
  if (changing->start == 0) return;
  double length = changing->length;
  for (const GrowingSegment& growing : growing_) {
    if (growing.segment != node - 1 && growing.segment != node) continue;
    length += 0.5 * (growing.end - growing.start);
  }
  changing->end = changing->start * changing->length / length;
  stiffness_[node] = changing->start + part_ * (changing->end - changing->start);
}

/// What the vectorised loop over all joints does not know: the changes of direction are those of segments that grow.
void Bending::add_growth(const VectorArray& displacement) {
  for (const GrowingSegment& g : growing_)
    for (const int node : {g.segment, g.segment + 1})
      if (node > 0 && node < segments_) set(change_, node, get(change_, node) + growth_at(node, g, displacement));
}

/// Of e, beyond what displacements make of it at the length of the middle.
Vector3 Bending::growth_at(int node, const GrowingSegment& g, const VectorArray& displacement) const {
  const int i = g.segment;
  const Vector3 moved = get(displacement, i + 1) - get(displacement, i);
  const double start = 1 / g.start, end = 1 / g.end;
  const Vector3 growth = (end - inverse_length_[i]) * moved + (end - start) * get(segment_, i);
  return node == i ? growth : Vector3(-growth);
}

double Bending::flow_force(int before, int after, const VectorArray& middle) const {
  if (!active_) return 0;
  double force = 0;
  const auto moment = [&](int node) -> Vector3 { return node > 0 && node < segments_ ? get(moment_, node) : Vector3::Zero(); };
  for (const GrowingSegment& g : growing_) {
    const int i = g.segment;
    if (i != before && i != after) continue;
    const double sign = i == before ? -1 : 1;
    const double slope = part_ == 1 ? -1 / (g.end * g.end) : -1 / (g.start * g.end);
    force -= sign * slope * get(middle, i).dot(moment(i) - moment(i + 1));
  }
  for (const ChangingJoint& joint : changing_) {
    if (joint.start == 0) continue;
    // Of the mean of the lengths of the two segments at it.
    const double share =
        0.5 * ((joint.node == after || joint.node == after + 1) - (joint.node == before || joint.node == before + 1));
    if (share == 0) continue;
    const Vector3 start = get(start_, joint.node), end = start + get(change_, joint.node);
    const double stiffness = joint.end / joint.length * (part_ == 1 ? joint.end / joint.start : 1);
    const double at_end = bend_energy(stiffness, numbers_of(end));
    force += share * (part_ == 1 ? at_end : 0.5 * (bend_energy(stiffness, numbers_of(start)) + at_end));
  }
  return force;
}

double Bending::flow_column(int before, int after, const VectorArray& middle, FlowColumn& column) const {
  column.fill(Vector3::Zero());
  if (!active_) return 0;
  // Directions change with the lengths that they are divided by, until the segments have these.
  const auto change = [&](int i) -> Vector3 {
    const double sign = i == before ? 1 : i == after ? -1 : 0;
    return sign * inverse_length_[i] * inverse_length_[i] * get(middle, i);
  };
  const auto pull = [&](int i, const Vector3& force) {
    column[i - before + 1] += force;
    column[i - before + 2] -= force;
  };
  double own = 0;
  for (int node = std::max(before, 1); node <= std::min(after + 1, segments_ - 1); ++node) {
    const Vector3 turned = change(node) - change(node - 1);
    const Vector3 moment = (part_ * slope_[node] + damping_[node]) * turned;
    own -= moment.dot(turned);
    pull(node, inverse_length_[node] * moment);
    pull(node - 1, -inverse_length_[node - 1] * moment);
  }
  return own;
}

/// What of the change of e over the substep is the material's own turn.
void Bending::turn_with_material(const CableModel& model, const CableState& state, const VectorArray& segment,
                                 const std::vector<HeldDirection>& directions, double h) {
  spin_.find(model, state, segment, directions, damping_, h);
  turned_square_ = 0;
  for (int i = 1; i < segments_; ++i) {
    const Vector3 turn = turn_of(get(segment, i - 1), get(segment, i), get(start_, i));
    set(turn_, i, turn);
    set(driven_, i, h * spin_.driven(i) * turn);
    set(turned_, i, h * spin_.own(i) * turn);
    turned_square_ += damping_at(i).square();
  }
  if (!spin_.is_driven()) return;
  for (ClampJoint& clamp : clamps_) {
    clamp.turn = turn_of(get(segment, clamp.segment), clamp.start_axis, clamp.start);
    clamp.angle = h * spin_of(directions[clamp.target], h);
  }
}

void Bending::add_segment_forces(const VectorArray& displacement, VectorArray& pull) {
  for (int i = 1; i < segments_; i += 2) {
    const PairVector here = neighbours(displacement, i);
    put(neighbours(inverse_length_, i) * (neighbours(displacement, i + 1) - here) -
            neighbours(inverse_length_, i - 1) * (here - neighbours(displacement, i - 1)),
        change_, i);
  }
  if (!growing_.empty()) add_growth(displacement);
  if (is_damped_) find_share();
  for (int i = 1; i < segments_; i += 2) {
    const PairVector change = neighbours(change_, i);
    Bend<Pair> joint = bend(neighbours(stiffness_, i), neighbours(start_, i), neighbours(start_square_, i), change, part_);
    if (is_damped_) joint.moment = joint.moment + damping_of_pair(i).moment(change, both(share_));
    put(joint.moment, moment_, i);
    put(joint.slope, slope_, i);
  }
  for (int i = 0; i < segments_; i += 2)
    put(neighbours(pull, i) + neighbours(inverse_length_, i) * (neighbours(moment_, i) - neighbours(moment_, i + 1)), pull, i);
  bend_clamps(displacement);
  for (const ClampJoint& clamp : clamps_) {
    const int i = clamp.segment;
    set(pull, i, get(pull, i) + inverse_length_[i] * clamp.moment);
  }
}

void Bending::bend_clamps(const VectorArray& displacement) {
  for (ClampJoint& clamp : clamps_) {
    const int i = clamp.segment;
    bend_clamp(part_, get(displacement, i + 1) - get(displacement, i), clamp);
  }
}

Vector3 Bending::damping_torque(const VectorArray& displacement) const {
  Vector3 torque = Vector3::Zero();
  if (!active_ || !is_damped_) return torque;
  for (int i = 1; i < segments_; ++i) {
    const Vector3 change = change_at(i, displacement);
    torque -= (get(start_, i) + part_ * change).cross(vector_of(damping_at(i).moment(numbers_of(change), share_)));
  }
  return torque;
}

double Bending::damping_work(const VectorArray& displacement) const {
  double work = 0;
  if (!active_ || !is_damped_) return work;
  for (int i = 1; i < segments_; ++i) work += damping_at(i).loss(numbers_of(change_at(i, displacement)), share_);
  return work;
}

double Bending::find_loss(const VectorArray& displacement) {
  bend_clamps(displacement);
  double loss = damping_work(displacement);
  for (const ClampJoint& clamp : clamps_) loss += clamp.damping_work;
  return loss;
}

BendDamping<double> Bending::damping_at(int node) const {
  return {damping_[node], numbers_at(driven_, node), numbers_at(turned_, node)};
}

BendDamping<Pair> Bending::damping_of_pair(int node) const {
  return {neighbours(damping_, node), neighbours(driven_, node), neighbours(turned_, node)};
}

void Bending::find_share() {
  Pair along{};
  for (int i = 1; i < segments_; i += 2) along += damping_of_pair(i).along(neighbours(change_, i));
  share_ = turned_share(along[0] + along[1], turned_square_);
}

void Bending::turn_clamps(const VectorArray& displacement, std::vector<HeldDirection>& directions) const {
  if (!spin_.is_driven()) return;
  for (int i = 1; i < segments_; ++i) {
    const Vector3 moment = vector_of(damping_at(i).moment(numbers_of(change_at(i, displacement)), share_));
    spin_.pass_on(i, moment.dot(get(turn_, i)), directions);
  }
}

/// Of e, over the substep.
Vector3 Bending::change_at(int node, const VectorArray& displacement) const {
  const Vector3 here = get(displacement, node);
  Vector3 change = inverse_length_[node] * (get(displacement, node + 1) - here) -
                   inverse_length_[node - 1] * (here - get(displacement, node - 1));
  for (const GrowingSegment& g : growing_)
    if (g.segment == node || g.segment + 1 == node) change += growth_at(node, g, displacement);
  return change;
}

void Bending::add_stiffness(KktSystem& system) const {
  const auto add = [&system](int i, double value) { system.diagonal[i] += value; };
  for (int i = 1; i < segments_; ++i) {
    const BendStiffness<double> stiffness =
        bend_stiffness(part_ * slope_[i] + damping_[i], inverse_length_[i - 1], inverse_length_[i]);
    add(i - 1, stiffness.before);
    add(i, stiffness.own);
    add(i + 1, stiffness.after);
    system.first[i - 1] += stiffness.first_before;
    system.first[i] += stiffness.first_after;
    system.second[i - 1] = stiffness.second;
  }
  for (const ClampJoint& clamp : clamps_) {
    const int i = clamp.segment;
    const double slope = stiffness_across(clamp, part_);
    add(i, slope);
    add(i + 1, slope);
    system.first[i] -= slope;
  }
}

void Bending::react(const VectorArray& displacement, std::vector<HeldDirection>& directions) {
  bend_clamps(displacement);
  for (const ClampJoint& clamp : clamps_) directions[clamp.target].torque += clamp.torque;
  if (is_damped_) turn_clamps(displacement, directions);
}

double bending_energy(const CableModel& model, const CableState& state, const std::vector<HeldDirection>& directions,
                      const std::vector<int>& shaped, int driven) {
  const CableMaterials materials(model, state);
  if (!materials.any_bends()) return 0;
  const int n = state.segments();
  const auto direction = [&](int i) -> Vector3 {
    const Vector3 d = state.positions[i + 1] - state.positions[i];
    const double inverse = 1 / (i == driven ? d.norm() : state.rest_lengths[i]);
    return inverse * d;
  };
  const auto joint = [](double length, const Vector3& change) { return bend_energy(1 / length, numbers_of(change)); };
  // EI is a factor of the sum where it is the same everywhere.
  const bool varies = materials.vary();
  double energy = 0;
  std::size_t clamp = 0;
  Vector3 before = direction(0);
  for (int i = 1; i < n; ++i) {
    const Vector3 after = direction(i);
    while (clamp < directions.size() && directions[clamp].node < i) ++clamp;
    const bool is_free = std::find(shaped.begin(), shaped.end(), i) == shaped.end();
    if (is_free && (clamp == directions.size() || directions[clamp].node != i)) {
      const double length = state.bending_length(i, 0.5 * (state.rest_lengths[i - 1] + state.rest_lengths[i]));
      const double stiffness = varies ? joint_material(materials, state, i).bending_stiffness.largest() : 1;
      energy += stiffness * joint(length, after - before);
    }
    before = after;
  }
  for (const HeldDirection& held : directions) {
    for (const int i : {held.node - 1, held.node}) {
      if (i < 0 || i >= n) continue;
      const double length = state.bending_length(held.node, 0.5 * state.rest_lengths[i]);
      energy += (varies ? JointMaterial(materials[i]).bending_stiffness.largest() : 1) *
                joint(length, direction(i) - direction(i).norm() * (held.end * Vector3::UnitX()));
    }
  }
  return varies ? energy : model.material.bending_stiffness.largest() * energy;
}

}  // namespace verlet_cable

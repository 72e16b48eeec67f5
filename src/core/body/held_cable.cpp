#include "body/held_cable.h"

#include <algorithm>

#include "body/body_contacts.h"
#include "body/body_joints.h"
#include "chain/point_motion.h"
#include "verlet_cable/core/cable_materials.h"

namespace verlet_cable {

namespace {

/// Of point masses and a body, in the axes of its frame.
void add_mass(double mass, const Vector3& point, MassProperties& whole) {
  const double sum = whole.mass + mass;
  const Vector3 way = point - whole.center_of_mass;
  const double reduced = whole.mass * mass / sum;
  whole.inertia += reduced * (way.squaredNorm() * Eigen::Matrix3d::Identity() - way * way.transpose());
  whole.center_of_mass += mass / sum * way;
  whole.mass = sum;
}

}  // namespace

void HeldCable::begin(int participant, const Participant& p, const std::vector<int>& member_of) {
  participant_ = participant;
  const Boundary& boundary = p.substep.boundary;
  sides_.clear();
  contacts_.clear();
  std::size_t d = 0;
  for (std::size_t k = 0; k < boundary.nodes.size(); ++k) {
    const HeldNode& held = boundary.nodes[k];
    Side side;
    side.node = held.node;
    side.entry = static_cast<int>(k);
    side.point = held.point;
    if (held.body >= 0) side.member = member_of[held.body];
    if (held.body >= 0) sides_.push_back(side);
    while (d < boundary.directions.size() && boundary.directions[d].node < held.node) ++d;
    if (d == boundary.directions.size() || boundary.directions[d].node != held.node || boundary.directions[d].body < 0) continue;
    side.entry = static_cast<int>(d);
    side.turns = true;
    side.member = member_of[boundary.directions[d].body];
    sides_.push_back(side);
  }
  find_stretches(p);
  find_others();
  share_turns();
  motion_.displacements.resize(boundary.nodes.size());
  motion_.rotations.resize(boundary.directions.size());
}

/// What happens on one side of a clamp is not felt on the other; nor what happens on one side of a held node, by what does not
/// bend. Material that flows is felt everywhere.
void HeldCable::find_stretches(const Participant& p) {
  const Boundary& boundary = p.substep.boundary;
  const CableMaterials materials(p.substep.model, *p.state);
  const bool bends = !p.state->directors.empty() || materials.any([](const MaterialDesc& material) {
    return material.bending_stiffness.largest() > 0 || material.bending_damping > 0;
  });
  int stretch = 0;
  auto side = sides_.begin();
  auto direction = boundary.directions.begin();
  for (const HeldNode& held : boundary.nodes) {
    while (direction != boundary.directions.end() && direction->node < held.node) ++direction;
    const bool clamped = direction != boundary.directions.end() && direction->node == held.node;
    const bool inside = held.node > 0 && held.node < p.state->segments();
    const bool separates = inside && (clamped || !bends) && boundary.flows.empty();
    for (; side != sides_.end() && side->node == held.node; ++side) {
      side->first_stretch = stretch;
      side->last_stretch = separates ? stretch + 1 : stretch;
    }
    if (separates) ++stretch;
  }
}

/// Stretches ascend with the sides: those that feel a side follow each other.
void HeldCable::find_others() {
  const int count = static_cast<int>(sides_.size());
  int first = 0, past = 0, blocks = 0;
  for (Side& side : sides_) {
    while (sides_[first].last_stretch < side.first_stretch) ++first;
    while (past < count && sides_[past].first_stretch <= side.last_stretch) ++past;
    side.first_other = first;
    side.past_others = past;
    side.first_block = blocks;
    blocks += past - first;
  }
  resistance_.resize(blocks);
}

/// The first turn in which nothing that feels a side feels another one.
void HeldCable::share_turns() {
  turns_.clear();
  for (Side& side : sides_) {
    const auto turn = std::find_if(turns_.begin(), turns_.end(), [&](int past) { return past <= side.first_other; });
    side.turn = static_cast<int>(turn - turns_.begin());
    if (turn == turns_.end())
      turns_.push_back(side.past_others);
    else
      *turn = side.past_others;
  }
}

void HeldCable::couple(BodyEquations& equations) {
  if (!contacts_.empty()) {
    members_.clear();
    for (const Side& side : sides_) members_.push_back(side.member);
    for (const Contact& contact : contacts_) members_.push_back(contact.member);
    std::sort(members_.begin(), members_.end());
    members_.erase(std::unique(members_.begin(), members_.end()), members_.end());
    for (const int a : members_)
      for (const int b : members_) equations.couple(a, b);
    return;
  }
  for (const Side& side : sides_)
    for (int other = side.first_other; other < side.past_others; ++other) equations.couple(side.member, sides_[other].member);
}

void HeldCable::add_masses(const Participant& p, std::vector<MovingBody>& bodies) const {
  for (const Side& side : sides_)
    if (!side.turns) add_mass(p.state->masses[p.substep.boundary.nodes[side.entry].node], side.point, bodies[side.member].whole);
}

void HeldCable::place_holders(const std::vector<MovingBody>& bodies, Boundary& boundary) const {
  for (const Side& side : sides_) {
    const RigidBodyStepper& stepper = bodies[side.member].stepper;
    if (side.turns) {
      HeldDirection& held = boundary.directions[side.entry];
      held.end = stepper.pose().orientation * held.on_body;
    } else {
      boundary.nodes[side.entry].position = stepper.position_of(side.point);
    }
  }
}

void HeldCable::set_holder_velocities(const std::vector<MovingBody>& bodies, Boundary& boundary) const {
  for (const Side& side : sides_)
    if (!side.turns) boundary.nodes[side.entry].velocity = bodies[side.member].stepper.velocity_of(side.point);
}

void HeldCable::add_contact(const Touch& touch, int member) {
  Contact& contact = contacts_.emplace_back();
  contact.touch = &touch;
  contact.member = member;
  contact.stiffness = slope(touch);
  contact.resistance = full_slope(touch);
}

void HeldCable::read_loads(const Participant& p, bool corrected) {
  p.stepper->read_holder_loads(p.substep, p.state->masses, corrected, loads_);
  for (Contact& contact : contacts_) {
    contact.change.setZero();
    if (!corrected) continue;
    const Vector3 way = at_point(contact.touch->point, p.stepper->correction());
    contact.change = contact.stiffness * way - contact.touch->followed;
  }
}

void HeldCable::read_impulses(const Participant& p) {
  p.stepper->read_impulses(p.substep.boundary, loads_);
}

Matrix36 HeldCable::motion_of(const Side& side, const RigidBodyStepper& body) {
  if (!side.turns) return point_motion(body.end_arm(side.point));
  Matrix36 turn;
  turn << Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Identity();
  return turn;
}

Matrix63 HeldCable::load_of(const Side& side, const RigidBodyStepper& body, BodyStage stage) {
  if (!side.turns) return verlet_cable::load_of(body, side.point, stage);
  Matrix63 turn;
  turn << Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Identity();
  return turn;
}

void HeldCable::add_loads(const std::vector<MovingBody>& bodies, BodyStage stage, BodyEquations& equations) const {
  for (const Side& side : sides_)
    equations.load(side.member) += load_of(side, bodies[side.member].stepper, stage) * load_of(side, loads_);
  if (stage == BodyStage::projection) return;
  for (const Contact& contact : contacts_) equations.load(contact.member) += load_on_body(*contact.touch) * contact.change;
}

void HeldCable::add_turning(double part, const std::vector<MovingBody>& bodies, BodyEquations& equations) const {
  for (const Side& side : sides_)
    if (!side.turns)
      verlet_cable::add_turning(part, bodies[side.member], side.member, side.point, loads_.forces[side.entry], equations);
}

/// Lets the sides move, one by one where any side would feel two of them.
void HeldCable::find_resistance(BodyStage stage, Participant& p) {
  motion_.loads.clear();
  motion_.clear();
  const bool turning_acts = stage == BodyStage::substep;
  for (int turn = 0; turn < static_cast<int>(turns_.size()); ++turn)
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      bool any = false;
      for (const Side& side : sides_) {
        if (side.turn != turn || (side.turns && !turning_acts)) continue;
        motion_of(side)[axis] = 1;
        any = true;
      }
      if (!any) continue;
      p.stepper->respond(p.substep.boundary, motion_, responses_);
      for (std::size_t moved = 0; moved < sides_.size(); ++moved) {
        const Side& side = sides_[moved];
        if (side.turn != turn || (side.turns && !turning_acts)) continue;
        motion_of(side).setZero();
        for (int other = side.first_other; other < side.past_others; ++other)
          resistance(sides_[other], static_cast<int>(moved)).col(axis) = -load_of(sides_[other], responses_);
      }
    }
}

void HeldCable::add_resistance(const std::vector<MovingBody>& bodies, BodyStage stage, Participant& p, BodyEquations& equations) {
  if (!contacts_.empty() && stage == BodyStage::substep) return add_touching_resistance(bodies, stage, p, equations);
  find_resistance(stage, p);
  const bool turning_acts = stage == BodyStage::substep;
  for (const Side& side : sides_) {
    if (side.turns && !turning_acts) continue;
    const Matrix63 load = load_of(side, bodies[side.member].stepper, stage);
    for (int k = side.first_other; k < side.past_others; ++k) {
      const Side& other = sides_[k];
      if (other.turns && !turning_acts) continue;
      equations.block(side.member, other.member).noalias() +=
          load * (resistance(side, k) * motion_of(other, bodies[other.member].stepper));
    }
  }
}

/// Lets the bodies move one by one: contacts may be many.
void HeldCable::add_touching_resistance(const std::vector<MovingBody>& bodies, BodyStage stage, Participant& p,
                                        BodyEquations& equations) {
  motion_.loads.clear();
  for (const Contact& contact : contacts_) motion_.loads.push_back({contact.touch->point, Vector3::Zero()});
  for (const int member : members_) {
    const RigidBodyStepper& moved = bodies[member].stepper;
    for (int column = 0; column < 6; ++column) {
      motion_.clear();
      for (const Side& side : sides_)
        if (side.member == member) motion_of(side) = motion_of(side, moved).col(column);
      for (std::size_t k = 0; k < contacts_.size(); ++k) {
        const Contact& contact = contacts_[k];
        if (contact.member == member) motion_.loads[k].force = contact.resistance * motion_on_body(*contact.touch).col(column);
      }
      p.stepper->respond(p.substep.boundary, motion_, responses_);
      for (const Side& side : sides_)
        equations.block(side.member, member).col(column) -=
            load_of(side, bodies[side.member].stepper, stage) * load_of(side, responses_);
      for (std::size_t k = 0; k < contacts_.size(); ++k) {
        const Contact& contact = contacts_[k];
        equations.block(contact.member, member).col(column) +=
            load_on_body(*contact.touch) * (motion_.loads[k].force - contact.stiffness * responses_.displacements[k]);
      }
    }
  }
}

void HeldCable::follow(const std::vector<MovingBody>& bodies, const BodyEquations& equations, Participant& p) {
  motion_.loads.clear();
  for (const Contact& contact : contacts_) {
    const Vector3 way = motion_on_body(*contact.touch) * equations.solution(contact.member);
    motion_.loads.push_back({contact.touch->point, contact.resistance * way});
  }
  std::fill(motion_.displacements.begin(), motion_.displacements.end(), Vector3::Zero());
  std::fill(motion_.rotations.begin(), motion_.rotations.end(), Vector3::Zero());
  for (const Side& side : sides_)
    motion_of(side) = motion_of(side, bodies[side.member].stepper) * equations.solution(side.member);
  p.stepper->add_moved(p.substep.boundary, motion_);
}

namespace {

/// Calls visitor(node) for those that nothing holds.
template <class Visitor>
void visit_free_nodes(const Participant& p, const Visitor& visitor) {
  auto held = p.substep.boundary.nodes.begin();
  for (int i = 0; i < p.state->nodes(); ++i) {
    if (held != p.substep.boundary.nodes.end() && held->node == i)
      ++held;
    else
      visitor(i);
  }
}

}  // namespace

void HeldCable::expect_momenta(const Participant& p, GroupMomenta& group) {
  const CableState& state = *p.state;
  for (const HeldNode& held : p.substep.boundary.nodes)
    if (held.body < 0) group.hold();
  visit_free_nodes(p, [&](int i) {
    const Vector3 way = get(p.stepper->displacement(), i);
    const Vector3 gain = p.substep.inertia() * (way / p.substep.h - state.velocities[i]);
    group.expect(state.masses[i], state.positions[i], way, state.velocities[i], gain);
  });
}

void HeldCable::add_momenta(const Participant& p, GroupMomenta& group) {
  visit_free_nodes(p, [&](int i) { group.add(p.state->masses[i], p.state->positions[i], p.state->velocities[i]); });
}

void HeldCable::add_motion(const RigidMotion& motion, Participant& p) {
  visit_free_nodes(p, [&](int i) { p.state->velocities[i] += motion.at(p.state->positions[i]); });
  for (HeldNode& held : p.substep.boundary.nodes) {
    const Vector3 gain = motion.at(p.state->positions[held.node]);
    held.velocity += gain;
    p.state->velocities[held.node] += gain;
  }
}

double HeldCable::work_of_held(const Participant& p) const {
  double work = 0;
  for (const Side& side : sides_) {
    if (side.turns) continue;
    const int node = p.substep.boundary.nodes[side.entry].node;
    work += get(p.stepper->system().load, node).dot(get(p.stepper->correction(), node));
  }
  return work;
}

}  // namespace verlet_cable

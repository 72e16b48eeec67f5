#include "body/body_system.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace verlet_cable {

namespace {

constexpr int body_iterations = 40;
/// Of the tolerance of cables: bodies are heavier, and what is left over works on them.
constexpr double body_part = 1e-3;
/// The same where bodies hold bodies: a joint's multiplier follows what is left.
constexpr double joint_part = 1e-5;
/// A correction that shrinks less than this from one iteration to the next calls for a new factorisation.
constexpr double slow_convergence = 0.1;
constexpr double least_size = 1e-3;  // [m] of a body

}  // namespace

void BodySystem::begin(const std::vector<BodyMember>& members, const std::vector<Participant>& participants,
                       const std::vector<SimulatedBody>& bodies, const std::vector<Load>& loads, const Environment& environment,
                       const SubstepRules& rules) {
  rules_ = rules;
  solutions_ = 0;
  member_of_.assign(bodies.size(), -1);
  members_.resize(members.size());
  momenta_.resize(members.size());
  for (std::size_t m = 0; m < members.size(); ++m) {
    const SimulatedBody& body = *members[m].start;
    member_of_[members[m].body] = static_cast<int>(m);
    members_[m].whole = {body.mass, body.center_of_mass, body.inertia};
  }
  find_cables(participants);
  for (std::size_t c = 0; c < cable_count_; ++c) cables_[c].add_masses(participants[cables_[c].participant()], members_);
  for (std::size_t m = 0; m < members.size(); ++m) {
    MovingBody& member = members_[m];
    member.size = std::sqrt(member.whole.inertia.trace() / member.whole.mass);
    member.stepper.begin(*members[m].start, *members[m].progress, member.whole, environment, rules);
  }
  for (const Load& load : loads)
    if (load.body.is_rigid_body() && member_of_[load.body.index] >= 0) members_[member_of_[load.body.index]].stepper.apply(load);
  contacts_.begin(members_, member_of_, rules.part());
}

/// Joints are set after the rest has begun.
void BodySystem::find_couples() {
  equations_.begin(static_cast<int>(members_.size()));
  for (std::size_t c = 0; c < cable_count_; ++c) cables_[c].couple(equations_);
  joints_.couple(equations_);
  equations_.end();
}

void BodySystem::find_cables(const std::vector<Participant>& participants) {
  cable_count_ = 0;
  cable_of_.assign(participants.size(), -1);
  for (std::size_t p = 0; p < participants.size(); ++p) {
    if (!participants[p].substep.boundary.is_on_bodies() && !participants[p].substep.touches_bodies) continue;
    cable_of_[p] = static_cast<int>(cable_count_);
    if (cables_.size() == cable_count_) cables_.emplace_back();
    cables_[cable_count_++].begin(static_cast<int>(p), participants[p], member_of_);
  }
}

void BodySystem::clear_cable_contacts() {
  for (std::size_t c = 0; c < cable_count_; ++c) cables_[c].clear_contacts();
}

void BodySystem::add_cable_contact(int participant, const Touch& touch) {
  cables_[cable_of_[participant]].add_contact(touch, member_of_[touch.body]);
}

void BodySystem::place_holders(std::vector<Participant>& participants) {
  for (std::size_t c = 0; c < cable_count_; ++c) {
    Participant& p = participants[cables_[c].participant()];
    cables_[c].place_holders(members_, p.substep.boundary);
    p.stepper->follow_holders(p.substep.boundary);
  }
}

bool BodySystem::advance(std::vector<Participant>& participants, double tolerance) {
  for (Participant& p : participants) {
    *p.result = {};
    p.stepper->begin(p.substep, *p.state, *p.result);
  }
  const double part = joints_.all().empty() ? body_part : joint_part;
  Convergence convergence(part * tolerance, rules_.h, rules_.statics);
  bool stale = true;
  for (int i = 0; i < body_iterations; ++i) {
    place_holders(participants);
    for (Participant& p : participants) {
      p.stepper->evaluate(p.substep, *p.state);
      stale = stale || p.stepper->calls_for_matrix();
    }
    for (Participant& p : participants) {
      if (stale) {
        p.stepper->assemble(p.substep.part());
        p.stepper->factor();
      }
      p.stepper->solve_linear();
      ++p.result->iterations;
    }
    solve(participants, stale);
    double size = 0;
    for (Participant& p : participants) size = larger(size, p.stepper->correct());
    size = larger(size, correct());
    if (!(size < largest_correction)) return false;
    const bool reached = convergence.is_reached(size);
    // Where rounding is what is left, the tolerance of cables is enough.
    const bool rounded = i > 1 && convergence.ratio() > rounding_ratio &&
                         size < tolerance * std::min(rules_.h, longest_tolerated);
    const bool consistent = std::all_of(participants.begin(), participants.end(),
                                        [](const Participant& p) { return p.stepper->flows_are_consistent(p.substep); });
    if ((reached || rounded) && consistent && !lacks_energy(participants, convergence)) {
      for (Participant& p : participants) p.result->converged = true;
      return true;
    }
    stale = i > 0 && convergence.ratio() > slow_convergence;
  }
  return false;
}

bool BodySystem::lacks_energy(const std::vector<Participant>& participants, const Convergence& convergence) const {
  double missing = 0, told = 0;
  for (const Participant& p : participants) {
    missing += std::abs(p.stepper->missing_work_of_tension(p.substep.part()));
    told += p.stepper->told_energy(p.substep, *p.state);
  }
  return !participants.empty() && convergence.lacks(missing, told);
}

/// What is out of balance at the bodies alone, and how they resist.
void BodySystem::evaluate(bool stale) {
  if (stale) {
    find_couples();
    equations_.clear_matrix();
  }
  for (std::size_t m = 0; m < members_.size(); ++m) {
    const int member = static_cast<int>(m);
    equations_.load(member) = members_[m].stepper.load();
    if (stale) equations_.block(member, member) = members_[m].stepper.stiffness();
  }
}

void BodySystem::condense(std::vector<Participant>& participants) {
  for (std::size_t c = 0; c < cable_count_; ++c) {
    cables_[c].add_turning(rules_.part(), members_, equations_);
    cables_[c].add_resistance(members_, BodyStage::substep, participants[cables_[c].participant()], equations_);
  }
  contacts_.add_stiffness(equations_);
  joints_.add_stiffness(rules_.part(), members_, equations_);
  equations_.factor();
}

/// Of cables, contacts and joints.
void BodySystem::add_loads() {
  for (std::size_t c = 0; c < cable_count_; ++c) cables_[c].add_loads(members_, BodyStage::substep, equations_);
  contacts_.add_loads(equations_);
  joints_.add_loads(members_, equations_);
}

void BodySystem::solve(std::vector<Participant>& participants, bool stale) {
  for (std::size_t c = 0; c < cable_count_; ++c) cables_[c].read_loads(participants[cables_[c].participant()], true);
  evaluate(stale);
  if (stale) condense(participants);
  add_loads();
  equations_.solve();
  ++solutions_;
  for (std::size_t c = 0; c < cable_count_; ++c) cables_[c].follow(members_, equations_, participants[cables_[c].participant()]);
}

double BodySystem::work_along(const std::vector<Participant>& participants) {
  double work = 0;
  for (std::size_t c = 0; c < cable_count_; ++c) {
    const Participant& p = participants[cables_[c].participant()];
    cables_[c].read_loads(p, false);
    work -= cables_[c].work_of_held(p);
  }
  evaluate(false);
  add_loads();
  return work + equations_.work();
}

void BodySystem::take_back(double part) {
  for (std::size_t m = 0; m < members_.size(); ++m) members_[m].stepper.correct(-part * equations_.solution(static_cast<int>(m)));
  joints_.take_back(part);
}

double BodySystem::correct() {
  joints_.correct(members_, equations_);
  double largest = 0;
  for (std::size_t m = 0; m < members_.size(); ++m) {
    const Vector6 change = equations_.solution(static_cast<int>(m));
    members_[m].stepper.correct(change);
    largest = larger(largest, change.head<3>().norm() / std::max(members_[m].size, least_size));
    largest = larger(largest, change.tail<3>().norm());
  }
  return largest;
}

void BodySystem::project(std::vector<Participant>& participants, std::vector<SimulatedBody>& bodies,
                         std::vector<BodyProgress>& progress) {
  add_inertia();
  clear_cable_contacts();
  add_impulses(participants);
  equations_.factor();
  equations_.solve();
  joints_.exert_impulses(rules_.h, members_, equations_);
  for (std::size_t c = 0; c < cable_count_; ++c) {
    if (!cables_[c].is_held()) continue;
    Participant& p = participants[cables_[c].participant()];
    cables_[c].follow(members_, equations_, p);
    p.stepper->finish_projection(p.substep, *p.state, *p.result);
  }
  for (std::size_t b = 0; b < member_of_.size(); ++b) {
    if (member_of_[b] < 0) continue;
    const MovingBody& member = members_[member_of_[b]];
    const Vector6 change = equations_.solution(member_of_[b]);
    const Vector3 gain = point_motion(member.stepper.end_arm(bodies[b].center_of_mass)) * change;
    bodies[b].velocity += gain;
    bodies[b].angular_velocity += change.tail<3>();
    progress[b].acceleration += change.head<3>() / rules_.h;
    progress[b].angular_acceleration += member.stepper.end().transpose() * change.tail<3>() / rules_.h;
  }
}

void BodySystem::add_inertia() {
  find_couples();
  equations_.clear_matrix();
  for (std::size_t m = 0; m < members_.size(); ++m) {
    const int member = static_cast<int>(m);
    equations_.load(member).setZero();
    equations_.block(member, member) = members_[m].stepper.inertia();
  }
}

/// Along inextensible segments and in joints.
void BodySystem::add_impulses(std::vector<Participant>& participants) {
  double mass = 0;
  for (const MovingBody& member : members_) mass += member.whole.mass + member.stepper.added_mass();
  for (const Participant& p : participants) mass += std::accumulate(p.state->masses.begin(), p.state->masses.end(), 0.0);
  joints_.add_impulses(mass, members_, equations_);
  for (std::size_t c = 0; c < cable_count_; ++c) {
    if (!cables_[c].is_held()) continue;
    Participant& p = participants[cables_[c].participant()];
    p.stepper->begin_projection(p.substep, *p.state);
    p.stepper->solve_linear();
    cables_[c].read_impulses(p);
    cables_[c].add_loads(members_, BodyStage::projection, equations_);
    cables_[c].add_resistance(members_, BodyStage::projection, p, equations_);
  }
}

void BodySystem::expect_momenta(const std::vector<Participant>& participants) {
  for (GroupMomenta& group : momenta_) group.begin();
  for (const BodyJoint& joint : joints_.all())
    if (joint.other < 0) group_of(joint.member).hold();
  // The fluid has a part of the momenta of added mass.
  for (std::size_t m = 0; m < members_.size(); ++m)
    if (members_[m].stepper.added_mass() > 0) group_of(static_cast<int>(m)).hold();
  for (std::size_t m = 0; m < members_.size(); ++m) members_[m].stepper.expect_momenta(group_of(static_cast<int>(m)));
  for (std::size_t c = 0; c < cable_count_; ++c)
    if (cables_[c].is_held())
      HeldCable::expect_momenta(participants[cables_[c].participant()], group_of(cables_[c].first_member()));
}

void BodySystem::restore_momenta(std::vector<Participant>& participants, std::vector<SimulatedBody>& bodies) {
  if (!keeps_momenta()) return;
  for (std::size_t m = 0; m < members_.size(); ++m) members_[m].stepper.add_momenta(group_of(static_cast<int>(m)));
  for (std::size_t c = 0; c < cable_count_; ++c)
    if (cables_[c].is_held()) HeldCable::add_momenta(participants[cables_[c].participant()], group_of(cables_[c].first_member()));
  for (std::size_t b = 0; b < member_of_.size(); ++b) {
    if (member_of_[b] < 0 || !group_of(member_of_[b]).is_free()) continue;
    const RigidMotion missing = group_of(member_of_[b]).missing();
    bodies[b].velocity += missing.at((bodies[b].pose * Pose{bodies[b].center_of_mass}).position);
    bodies[b].angular_velocity += missing.rate;
  }
  for (std::size_t c = 0; c < cable_count_; ++c) {
    if (!cables_[c].is_held()) continue;
    const GroupMomenta& group = group_of(cables_[c].first_member());
    if (group.is_free()) HeldCable::add_motion(group.missing(), participants[cables_[c].participant()]);
  }
}

void BodySystem::place_at_end(std::vector<Participant>& participants) {
  place_holders(participants);
  if (keeps_momenta()) expect_momenta(participants);
  for (std::size_t c = 0; c < cable_count_; ++c)
    cables_[c].set_holder_velocities(members_, participants[cables_[c].participant()].substep.boundary);
  joints_.exert(rules_.scheme);
}

double BodySystem::largest_displacement() const {
  double largest = 0;
  for (const MovingBody& member : members_)
    largest = std::max(largest, member.stepper.displacement().norm() + member.size * member.stepper.turn().norm());
  return largest;
}

void BodySystem::finish(int member, SimulatedBody& body, BodyProgress& progress) const {
  members_[member].stepper.finish(body, progress);
}

}  // namespace verlet_cable

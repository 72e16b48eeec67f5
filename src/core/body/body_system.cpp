#include "body/body_system.h"

#include <algorithm>
#include <cmath>

namespace verlet_cable {

namespace {

/// Of joints, relative to what resists beside them: what is left of a gap after an iteration.
constexpr double holding_part = 1e7;
constexpr int maximum_iterations = 40;
/// Of the tolerance of cables: bodies are heavier, and what is left over works on them.
constexpr double body_part = 1e-5;
/// Corrections that do not shrink to less than this part are made of rounding: the tolerance of cables is enough then.
constexpr double rounding_ratio = 0.5;
/// A correction that shrinks less than this from one iteration to the next calls for a new factorisation.
constexpr double slow_convergence = 0.1;
constexpr double least_size = 1e-3;  // [m] of a body

using Matrix36 = Eigen::Matrix<double, 3, 6>;
using Matrix63 = Eigen::Matrix<double, 6, 3>;

Matrix36 point_motion(const Vector3& arm) {
  Matrix36 m;
  m << Eigen::Matrix3d::Identity(), -cross_matrix(arm);
  return m;
}

Matrix63 point_load(const Vector3& arm) {
  Matrix63 m;
  m << Eigen::Matrix3d::Identity(), cross_matrix(arm);
  return m;
}

/// By what the torque of a force that stays as it is changes as its arm turns.
Eigen::Matrix3d turned_torque(const Vector3& arm, const Vector3& force) {
  return arm * force.transpose() - arm.dot(force) * Eigen::Matrix3d::Identity();
}

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

void BodySystem::begin(const std::vector<BodyMember>& members, const std::vector<Participant>& participants,
                       const std::vector<SimulatedBody>& bodies, const GravityDesc& gravity, const SubstepRules& rules) {
  rules_ = rules;
  place_.assign(bodies.size(), -1);
  members_.resize(members.size());
  for (std::size_t m = 0; m < members.size(); ++m) place_[members[m].body] = static_cast<int>(m);
  find_sides(participants);
  for (std::size_t m = 0; m < members.size(); ++m) {
    gather_mass(*members[m].start, static_cast<int>(m), participants);
    Member& member = members_[m];
    member.size = std::sqrt(member.whole.inertia.trace() / member.whole.mass);
    member.stepper.begin(*members[m].start, *members[m].progress, member.whole, gravity, rules);
  }
  const auto unknowns = static_cast<Eigen::Index>(6 * members.size());
  if (matrix_.rows() != unknowns) {
    matrix_.resize(unknowns, unknowns);
    load_.resize(unknowns);
    change_.resize(unknowns);
  }
}

void BodySystem::find_sides(const std::vector<Participant>& participants) {
  cable_count_ = 0;
  for (std::size_t p = 0; p < participants.size(); ++p) {
    const Boundary& boundary = participants[p].substep.boundary;
    if (!boundary.is_on_bodies()) continue;
    if (cables_.size() == cable_count_) cables_.emplace_back();
    HeldCable& cable = cables_[cable_count_++];
    cable.participant = static_cast<int>(p);
    cable.sides.clear();
    for (std::size_t k = 0; k < boundary.nodes.size(); ++k)
      if (boundary.nodes[k].body >= 0)
        cable.sides.push_back({place_[boundary.nodes[k].body], static_cast<int>(k), false, boundary.nodes[k].point});
    for (std::size_t k = 0; k < boundary.directions.size(); ++k)
      if (boundary.directions[k].body >= 0)
        cable.sides.push_back({place_[boundary.directions[k].body], static_cast<int>(k), true, Vector3::Zero()});
    const auto rows = static_cast<Eigen::Index>(3 * cable.sides.size());
    if (cable.resistance.rows() != rows) cable.resistance.resize(rows, rows);
    cable.motion.displacements.resize(boundary.nodes.size());
    cable.motion.rotations.resize(boundary.directions.size());
  }
}

/// A body moves as one with the nodes that it holds.
void BodySystem::gather_mass(const SimulatedBody& body, int member, const std::vector<Participant>& participants) {
  MassProperties& whole = members_[member].whole;
  whole = {body.mass, body.center_of_mass, body.inertia};
  for (std::size_t c = 0; c < cable_count_; ++c) {
    const Participant& p = participants[cables_[c].participant];
    for (const Side& side : cables_[c].sides)
      if (side.member == member && !side.turns)
        add_mass(p.state->masses[p.substep.boundary.nodes[side.entry].node], side.point, whole);
  }
}

void BodySystem::place_holders(std::vector<Participant>& participants) {
  for (std::size_t c = 0; c < cable_count_; ++c) {
    Participant& p = participants[cables_[c].participant];
    for (const Side& side : cables_[c].sides) {
      const RigidBodyStepper& stepper = members_[side.member].stepper;
      if (side.turns) {
        HeldDirection& held = p.substep.boundary.directions[side.entry];
        held.end = stepper.pose().orientation * held.on_body;
      } else {
        p.substep.boundary.nodes[side.entry].position = stepper.position_of(side.point);
      }
    }
    p.stepper->follow_holders(p.substep.boundary);
  }
}

Matrix36 BodySystem::motion_of(const Side& side, const RigidBodyStepper& stepper) {
  if (!side.turns) return point_motion(stepper.end_arm(side.point));
  Matrix36 turn;
  turn << Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Identity();
  return turn;
}

Matrix63 BodySystem::load_of(const Side& side, const RigidBodyStepper& stepper) {
  if (!side.turns) return point_load(stepper.force_arm(side.point));
  Matrix63 turn;
  turn << Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Identity();
  return turn;
}

Matrix63 BodySystem::impulse_of(const Side& side, const RigidBodyStepper& stepper) {
  return motion_of(side, stepper).transpose();
}

bool BodySystem::advance(std::vector<Participant>& participants, double tolerance) {
  for (Participant& p : participants) {
    p.result = {};
    p.stepper->begin(p.substep, *p.state, p.result);
  }
  Convergence convergence(body_part * tolerance, rules_.h, rules_.statics);
  bool stale = true;
  for (int i = 0; i < maximum_iterations; ++i) {
    place_holders(participants);
    for (Participant& p : participants) {
      p.stepper->evaluate(p.substep, *p.state);
      if (stale) {
        p.stepper->assemble(p.substep.part());
        p.stepper->factor();
      }
      p.stepper->solve_linear();
      ++p.result.iterations;
    }
    solve(participants, stale);
    double size = 0;
    for (Participant& p : participants) {
      const double of_cable = p.stepper->correct();
      size = of_cable <= size ? size : of_cable;
    }
    const double of_bodies = correct();
    size = of_bodies <= size ? size : of_bodies;
    if (!(size < largest_correction)) return false;
    const bool reached = convergence.is_reached(size);
    const bool rounded = !rules_.statics && i > 1 && convergence.ratio() > rounding_ratio &&
                         size < tolerance * std::min(rules_.h, longest_tolerated);
    const bool consistent = std::all_of(participants.begin(), participants.end(), [](const Participant& p) {
      return p.stepper->flows_are_consistent(p.substep);
    });
    if ((reached || rounded) && consistent) {
      for (Participant& p : participants) p.result.converged = true;
      return true;
    }
    stale = i > 0 && convergence.ratio() > slow_convergence;
  }
  return false;
}

void BodySystem::condense(std::vector<Participant>& participants) {
  matrix_.setZero();
  for (std::size_t m = 0; m < members_.size(); ++m) {
    Vector6 unused;
    Matrix6 own;
    members_[m].stepper.evaluate(unused, own);
    matrix_.block<6, 6>(6 * m, 6 * m) = own;
  }
  for (std::size_t c = 0; c < cable_count_; ++c) {
    for (const Side& side : cables_[c].sides)
      if (!side.turns) add_turning(side.member, side.point, cables_[c].loads.forces[side.entry]);
    add_resistance(cables_[c], participants[cables_[c].participant], &BodySystem::load_of);
  }
  find_holding();
  for (BodyJoint& joint : joints_) add_joint(joint, true);
  solver_.compute(matrix_);
}

/// Where a force stays as it is, its torque changes as its arm turns.
void BodySystem::add_turning(int member, const Vector3& point, const Vector3& force) {
  const Vector3 arm = members_[member].stepper.end_arm(point);
  matrix_.block<3, 3>(6 * member + 3, 6 * member + 3) -= rules_.part() * turned_torque(arm, force);
}

/// Lets the sides of a cable move one by one.
void BodySystem::add_resistance(HeldCable& cable, Participant& p, LoadOf load_of) {
  const int count = static_cast<int>(cable.sides.size());
  cable.motion.clear();
  for (int column = 0; column < 3 * count; ++column) {
    const Side& moved = cable.sides[column / 3];
    Vector3& motion = moved.turns ? cable.motion.rotations[moved.entry] : cable.motion.displacements[moved.entry];
    motion[column % 3] = 1;
    p.stepper->respond(p.substep.boundary, cable.motion, cable.responses);
    motion.setZero();
    for (int row = 0; row < count; ++row) {
      const Side& side = cable.sides[row];
      cable.resistance.block<3, 1>(3 * row, column) =
          -(side.turns ? cable.responses.torques[side.entry] : cable.responses.forces[side.entry]);
    }
  }
  for (int i = 0; i < count; ++i) {
    const Side& a = cable.sides[i];
    const Matrix63 load = load_of(a, members_[a.member].stepper);
    for (int j = 0; j < count; ++j) {
      const Side& b = cable.sides[j];
      matrix_.block<6, 6>(6 * a.member, 6 * b.member) +=
          load * cable.resistance.block<3, 3>(3 * i, 3 * j) * motion_of(b, members_[b.member].stepper);
    }
  }
}

/// [m] From the point of the held body to where it is to be.
Vector3 BodySystem::gap_of(const BodyJoint& joint) const {
  const Vector3 place =
      joint.other < 0 ? joint.holder.position : members_[joint.other].stepper.position_of(joint.holder.position);
  return place - members_[joint.member].stepper.position_of(joint.at.position);
}

/// [rad] By what the held body is to turn.
Vector3 BodySystem::turn_of(const BodyJoint& joint) const {
  const Quaternion own = members_[joint.member].stepper.pose().orientation * joint.at.orientation;
  const Quaternion wanted =
      joint.other < 0 ? joint.holder.orientation : members_[joint.other].stepper.pose().orientation * joint.holder.orientation;
  if (joint.type == AttachmentType::axle) return (own * Vector3::UnitZ()).cross(wanted * Vector3::UnitZ());
  Quaternion turn = wanted * own.conjugate();
  return (turn.w() < 0 ? -2 : 2) * turn.vec();
}

/// Takes from a turn what a joint allows: an axle that about its axis.
Eigen::Matrix3d BodySystem::held_turns_of(const BodyJoint& joint) const {
  Eigen::Matrix3d held = Eigen::Matrix3d::Identity();
  if (joint.type != AttachmentType::axle) return held;
  const Vector3 axis = members_[joint.member].stepper.pose().orientation * joint.at.orientation * Vector3::UnitZ();
  held -= axis * axis.transpose();
  return held;
}

/// Adds what a joint exerts; or what resists, to the matrix.
void BodySystem::add_joint(BodyJoint& joint, bool stiffness) {
  const bool turns = joint.type != AttachmentType::hinge;
  const Eigen::Matrix3d held_turns = held_turns_of(joint);
  // On the body that is held, and with the other sign on the other one
  const auto load_on = [&](int m, const Vector3& point, double sign) {
    const Matrix63 load = sign * point_load(members_[m].stepper.force_arm(point));
    return load;
  };
  struct End {
    int member;
    Matrix63 load;
    Matrix36 motion;
    double sign;
  };
  std::array<End, 2> ends;
  int count = 0;
  ends[count++] = {joint.member, load_on(joint.member, joint.at.position, 1),
                   point_motion(members_[joint.member].stepper.end_arm(joint.at.position)), 1};
  if (joint.other >= 0)
    ends[count++] = {joint.other, load_on(joint.other, joint.holder.position, -1),
                     -point_motion(members_[joint.other].stepper.end_arm(joint.holder.position)), -1};
  if (!stiffness) {
    const Vector3 force = joint.force + holding_ * gap_of(joint);
    Vector3 torque = Vector3::Zero();
    if (turns) torque = held_turns * (joint.torque + holding_turn_ * turn_of(joint));
    for (int i = 0; i < count; ++i) {
      load_.segment<6>(6 * ends[i].member) += ends[i].load * force;
      load_.segment<3>(6 * ends[i].member + 3) += ends[i].sign * torque;
    }
    return;
  }
  add_turning(joint.member, joint.at.position, joint.force);
  if (joint.other >= 0) add_turning(joint.other, joint.holder.position, -joint.force);
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < count; ++j) {
      auto block = matrix_.block<6, 6>(6 * ends[i].member, 6 * ends[j].member);
      block += holding_ * ends[i].load * ends[j].motion;
      if (turns) block.bottomRightCorner<3, 3>() += holding_turn_ * ends[i].sign * ends[j].sign * held_turns;
    }
}

void BodySystem::solve(std::vector<Participant>& participants, bool stale) {
  for (std::size_t c = 0; c < cable_count_; ++c) {
    const Participant& p = participants[cables_[c].participant];
    p.stepper->read_holder_loads(p.substep, p.state->masses, true, cables_[c].loads);
  }
  if (stale) condense(participants);
  gather_loads();
  change_.noalias() = solver_.solve(load_);
  for (std::size_t c = 0; c < cable_count_; ++c) {
    HeldCable& cable = cables_[c];
    Participant& p = participants[cable.participant];
    move_sides(cable);
    p.stepper->add_moved(p.substep.boundary, cable.motion);
  }
}

/// What is out of balance at bodies.
void BodySystem::gather_loads() {
  for (std::size_t m = 0; m < members_.size(); ++m) {
    Vector6 own;
    Matrix6 unused;
    members_[m].stepper.evaluate(own, unused);
    load_.segment<6>(6 * m) = own;
  }
  for (std::size_t c = 0; c < cable_count_; ++c) {
    const HeldCable& cable = cables_[c];
    for (const Side& side : cable.sides)
      load_.segment<6>(6 * side.member) += load_of(side, members_[side.member].stepper) *
                                           (side.turns ? cable.loads.torques[side.entry] : cable.loads.forces[side.entry]);
  }
  for (BodyJoint& joint : joints_) add_joint(joint, false);
}

double BodySystem::work_along(const std::vector<Participant>& participants) {
  double work = 0;
  for (std::size_t c = 0; c < cable_count_; ++c) {
    HeldCable& cable = cables_[c];
    CableStepper& stepper = *participants[cable.participant].stepper;
    const Substep& substep = participants[cable.participant].substep;
    stepper.read_holder_loads(substep, participants[cable.participant].state->masses, false, cable.loads);
    // What the cable's own work has of nodes that move with bodies.
    for (const Side& side : cable.sides) {
      if (side.turns) continue;
      const int node = substep.boundary.nodes[side.entry].node;
      work -= get(stepper.system().load, node).dot(get(stepper.correction(), node));
    }
  }
  gather_loads();
  return work + load_.dot(change_);
}

void BodySystem::take_back(double part) {
  for (std::size_t m = 0; m < members_.size(); ++m) members_[m].stepper.correct(-part * change_.segment<6>(6 * m));
  for (BodyJoint& joint : joints_) {
    joint.force -= part * joint.force_change;
    joint.torque -= part * joint.torque_change;
  }
}

double BodySystem::correct() {
  // Multipliers take over what the gaps that are left call for.
  for (BodyJoint& joint : joints_) {
    const Vector6 own = change_.segment<6>(6 * joint.member);
    Vector3 way = point_motion(members_[joint.member].stepper.end_arm(joint.at.position)) * own, turn = own.tail<3>();
    if (joint.other >= 0) {
      const Vector6 other = change_.segment<6>(6 * joint.other);
      way -= point_motion(members_[joint.other].stepper.end_arm(joint.holder.position)) * other;
      turn -= other.tail<3>();
    }
    joint.force_change = holding_ * (gap_of(joint) - way);
    joint.force += joint.force_change;
    if (joint.type == AttachmentType::hinge) continue;
    const Vector3 torque = held_turns_of(joint) * (joint.torque + holding_turn_ * (turn_of(joint) - turn));
    joint.torque_change = torque - joint.torque;
    joint.torque = torque;
  }
  double largest = 0;
  for (std::size_t m = 0; m < members_.size(); ++m) {
    const Vector6 change = change_.segment<6>(6 * m);
    members_[m].stepper.correct(change);
    const double size = std::max(change.head<3>().norm() / std::max(members_[m].size, least_size), change.tail<3>().norm());
    largest = size <= largest ? largest : size;  // keeps a NaN
  }
  return largest;
}

void BodySystem::project(std::vector<Participant>& participants, std::vector<SimulatedBody>& bodies,
                         std::vector<BodyProgress>& progress) {
  matrix_.setZero();
  load_.setZero();
  for (std::size_t m = 0; m < members_.size(); ++m) {
    const Eigen::Matrix3d& end = members_[m].stepper.end();
    matrix_.block<3, 3>(6 * m, 6 * m).diagonal().setConstant(members_[m].whole.mass);
    matrix_.block<3, 3>(6 * m + 3, 6 * m + 3) = end * members_[m].whole.inertia * end.transpose();
  }
  for (std::size_t c = 0; c < cable_count_; ++c) {
    HeldCable& cable = cables_[c];
    Participant& p = participants[cable.participant];
    p.stepper->begin_projection(p.substep, *p.state);
    p.stepper->solve_linear();
    p.stepper->read_impulses(p.substep.boundary, cable.loads);
    for (const Side& side : cable.sides)
      if (!side.turns)
        load_.segment<6>(6 * side.member) += impulse_of(side, members_[side.member].stepper) * cable.loads.forces[side.entry];
    add_resistance(cable, p, &BodySystem::impulse_of);
  }
  find_holding();
  for (const BodyJoint& joint : joints_) project_joint(joint);
  solver_.compute(matrix_);
  change_.noalias() = solver_.solve(load_);
  for (std::size_t c = 0; c < cable_count_; ++c) {
    HeldCable& cable = cables_[c];
    Participant& p = participants[cable.participant];
    move_sides(cable);
    p.stepper->add_moved(p.substep.boundary, cable.motion);
    p.stepper->finish_projection(p.substep, *p.state);
  }
  for (std::size_t b = 0; b < place_.size(); ++b) {
    if (place_[b] < 0) continue;
    const Member& member = members_[place_[b]];
    const Vector6 change = change_.segment<6>(6 * place_[b]);
    const Vector3 gain = point_motion(member.stepper.end_arm(bodies[b].center_of_mass)) * change;
    bodies[b].velocity += gain;
    bodies[b].angular_velocity += change.tail<3>();
    progress[b].acceleration += change.head<3>() / rules_.h;
    progress[b].angular_acceleration += member.stepper.end().transpose() * change.tail<3>() / rules_.h;
  }
}

/// Lets a joint end the velocities that it does not allow.
void BodySystem::project_joint(const BodyJoint& joint) {
  const RigidBodyStepper& own = members_[joint.member].stepper;
  const Matrix36 motion = point_motion(own.end_arm(joint.at.position));
  Vector3 gap = joint.holder_velocity.linear - own.velocity_of(joint.at.position);
  Vector3 turning = joint.holder_velocity.angular - own.spin();
  const Eigen::Matrix3d held_turns = held_turns_of(joint);
  std::array<int, 2> members{joint.member, joint.other};
  std::array<Matrix36, 2> motions{motion, motion};
  const int count = joint.other < 0 ? 1 : 2;
  if (count == 2) {
    const RigidBodyStepper& other = members_[joint.other].stepper;
    gap += other.velocity_of(joint.holder.position);
    turning += other.spin();
    motions[1] = -point_motion(other.end_arm(joint.holder.position));
  }
  const bool turns = joint.type != AttachmentType::hinge;
  for (int i = 0; i < count; ++i) {
    const double sign = i == 0 ? 1 : -1;
    load_.segment<6>(6 * members[i]) += holding_ * motions[i].transpose() * gap;
    if (turns) load_.segment<3>(6 * members[i] + 3) += sign * holding_turn_ * (held_turns * turning);
    for (int j = 0; j < count; ++j) {
      auto block = matrix_.block<6, 6>(6 * members[i], 6 * members[j]);
      block += holding_ * motions[i].transpose() * motions[j];
      if (turns) block.bottomRightCorner<3, 3>() += (i == j ? holding_turn_ : -holding_turn_) * held_turns;
    }
  }
}

/// How cables' sides move with their bodies.
void BodySystem::move_sides(HeldCable& cable) const {
  cable.motion.clear();
  for (const Side& side : cable.sides) {
    const Vector3 motion = motion_of(side, members_[side.member].stepper) * change_.segment<6>(6 * side.member);
    (side.turns ? cable.motion.rotations[side.entry] : cable.motion.displacements[side.entry]) = motion;
  }
}

void BodySystem::find_holding() {
  holding_ = holding_turn_ = 0;
  for (std::size_t m = 0; m < members_.size(); ++m) {
    holding_ = std::max(holding_, holding_part * matrix_.block<3, 3>(6 * m, 6 * m).cwiseAbs().maxCoeff());
    holding_turn_ = std::max(holding_turn_, holding_part * matrix_.block<3, 3>(6 * m + 3, 6 * m + 3).cwiseAbs().maxCoeff());
  }
}

void BodySystem::place_at_end(std::vector<Participant>& participants) {
  place_holders(participants);
  for (std::size_t c = 0; c < cable_count_; ++c) {
    Participant& p = participants[cables_[c].participant];
    for (const Side& side : cables_[c].sides)
      if (!side.turns) p.substep.boundary.nodes[side.entry].velocity = members_[side.member].stepper.velocity_of(side.point);
  }
}

double BodySystem::largest_displacement() const {
  double largest = 0;
  for (const Member& member : members_)
    largest = std::max(largest, member.stepper.displacement().norm() + member.size * member.stepper.turn().norm());
  return largest;
}

void BodySystem::finish(int member, SimulatedBody& body, BodyProgress& progress) const {
  members_[member].stepper.finish(body, progress);
}

}  // namespace verlet_cable

#include "body/held_cable.h"

#include "body/body_joints.h"

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

void HeldCable::begin(int participant, const Boundary& boundary, const std::vector<int>& member_of) {
  participant_ = participant;
  sides_.clear();
  for (std::size_t k = 0; k < boundary.nodes.size(); ++k)
    if (boundary.nodes[k].body >= 0)
      sides_.push_back({member_of[boundary.nodes[k].body], static_cast<int>(k), false, boundary.nodes[k].point});
  for (std::size_t k = 0; k < boundary.directions.size(); ++k)
    if (boundary.directions[k].body >= 0)
      sides_.push_back({member_of[boundary.directions[k].body], static_cast<int>(k), true, Vector3::Zero()});
  const auto rows = static_cast<Eigen::Index>(3 * sides_.size());
  if (resistance_.rows() != rows) resistance_.resize(rows, rows);
  motion_.displacements.resize(boundary.nodes.size());
  motion_.rotations.resize(boundary.directions.size());
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

void HeldCable::read_loads(const Participant& p, bool corrected) {
  p.stepper->read_holder_loads(p.substep, p.state->masses, corrected, loads_);
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
}

void HeldCable::add_turning(double part, const std::vector<MovingBody>& bodies, BodyEquations& equations) const {
  for (const Side& side : sides_)
    if (!side.turns)
      verlet_cable::add_turning(part, bodies[side.member], side.member, side.point, loads_.forces[side.entry], equations);
}

/// Lets the sides move one by one.
void HeldCable::find_resistance(Participant& p) {
  motion_.clear();
  for (std::size_t column = 0; column < 3 * sides_.size(); ++column) {
    Vector3& motion = motion_of(sides_[column / 3]);
    motion[static_cast<Eigen::Index>(column % 3)] = 1;
    p.stepper->respond(p.substep.boundary, motion_, responses_);
    motion.setZero();
    for (std::size_t row = 0; row < sides_.size(); ++row)
      resistance_.block<3, 1>(static_cast<Eigen::Index>(3 * row), static_cast<Eigen::Index>(column)) =
          -load_of(sides_[row], responses_);
  }
}

void HeldCable::add_resistance(const std::vector<MovingBody>& bodies, BodyStage stage, Participant& p, BodyEquations& equations) {
  find_resistance(p);
  for (std::size_t i = 0; i < sides_.size(); ++i) {
    const Side& a = sides_[i];
    const Matrix63 load = load_of(a, bodies[a.member].stepper, stage);
    for (std::size_t j = 0; j < sides_.size(); ++j) {
      const Side& b = sides_[j];
      equations.block(a.member, b.member) +=
          load * resistance_.block<3, 3>(static_cast<Eigen::Index>(3 * i), static_cast<Eigen::Index>(3 * j)) *
          motion_of(b, bodies[b.member].stepper);
    }
  }
}

void HeldCable::follow(const std::vector<MovingBody>& bodies, const BodyEquations& equations, Participant& p) {
  motion_.clear();
  for (const Side& side : sides_)
    motion_of(side) = motion_of(side, bodies[side.member].stepper) * equations.solution(side.member);
  p.stepper->add_moved(p.substep.boundary, motion_);
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

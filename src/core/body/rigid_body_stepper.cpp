#include "body/rigid_body_stepper.h"

namespace verlet_cable {

namespace {

Quaternion cayley(const Vector3& vector) {
  return Quaternion(1, 0.5 * vector.x(), 0.5 * vector.y(), 0.5 * vector.z()).normalized();
}

Vector3 cayley_vector(const Quaternion& rotation) {
  return 2 / rotation.w() * rotation.vec();
}

/// By what the Cayley vector w changes as the end is rotated.
Eigen::Matrix3d turned_cayley(const Vector3& w) {
  return Eigen::Matrix3d::Identity() + 0.25 * w * w.transpose() - 0.5 * cross_matrix(w);
}

}  // namespace

void RigidBodyStepper::begin(const SimulatedBody& body, const BodyProgress& progress, const MassProperties& whole,
                             const Environment& environment, const SubstepRules& rules) {
  rules_ = rules;
  whole_ = whole;
  mass_ = body.mass;
  own_ = body.center_of_mass - whole.center_of_mass;
  linear_damping_ = rules.statics ? 0 : body.linear_damping;
  angular_damping_ = rules.statics ? 0 : body.angular_damping;
  gravity_ = &environment.gravity;
  applied_.clear();
  orientation_ = body.pose.orientation;
  start_ = orientation_.toRotationMatrix();
  center_ = body.pose.position + start_ * whole.center_of_mass;
  velocity_ = acceleration_ = spin_ = spin_change_ = Vector3::Zero();
  if (!rules.statics) {
    const Vector3 arm = start_ * own_;
    spin_ = start_.transpose() * body.angular_velocity;
    spin_change_ = progress.angular_acceleration;
    velocity_ = body.velocity - body.angular_velocity.cross(arm);
    acceleration_ = progress.acceleration;
  }
  const Vector3 arm = body.fluid.center - whole.center_of_mass;
  fluid_.begin(body.fluid, environment, rules.middle, rules.h, rules.statics, center_ + start_ * arm,
               velocity_ + (start_ * spin_).cross(start_ * arm), arm);
  added_mass_ = body.fluid.added_mass.maxCoeff();
  if (added_mass_ > 0) add_mass(body.fluid);
  displacement_ = rules.h * (velocity_ + 0.5 * rules.h * acceleration_);
  turn_by(orientation_ * cayley(rules.h * (spin_ + 0.5 * rules.h * spin_change_)));
}

/// At the center of the fluid, whose velocity is V + W x arm.
void RigidBodyStepper::add_mass(const BodyFluidDesc& fluid) {
  const Eigen::Matrix3d added = fluid.added_mass.asDiagonal(), arm = cross_matrix(fluid.center - whole_.center_of_mass);
  inertia_ << whole_.mass * Eigen::Matrix3d::Identity() + added, -added * arm, arm * added, whole_.inertia - arm * added * arm;
  const Vector3 velocity = start_.transpose() * (velocity_ - fluid_.flow());
  rate_ << velocity, spin_;
  rate_change_ << start_.transpose() * acceleration_ - spin_.cross(velocity), spin_change_;
}

void RigidBodyStepper::turn_by(const Quaternion& end) {
  end_orientation_ = end.normalized();
  end_ = end_orientation_.toRotationMatrix();
  turn_ = cayley_vector(orientation_.conjugate() * end_orientation_);
}

Pose RigidBodyStepper::pose() const {
  return {position_of(Vector3::Zero()), end_orientation_};
}

Vector3 RigidBodyStepper::position_of(const Vector3& point) const {
  return center_ + displacement_ + end_arm(point);
}

Vector3 RigidBodyStepper::force_arm(const Vector3& point) const {
  const Vector3 arm = point - whole_.center_of_mass;
  const double part = rules_.part();
  return (1 - part) * (start_ * arm) + part * (end_ * arm);
}

Vector3 RigidBodyStepper::weight() const {
  return mass_ * gravity_->at(center_ + 0.5 * rules_.h * velocity_ + start_ * own_);
}

/// What turns with the body has the mean of its axes at the start and the end, as arms do: work is then force times way and
/// torque times turn.
RigidBodyStepper::Wrench RigidBodyStepper::wrench_of(const Load& load) const {
  Vector3 force = load.force, torque = load.torque;
  if (load.is_local) {
    const double part = rules_.part();
    force = (1 - part) * (start_ * load.force) + part * (end_ * load.force);
    torque = (1 - part) * (start_ * load.torque) + part * (end_ * load.torque);
  }
  return {force, force_arm(load.point).cross(force) + torque};
}

/// By what the load gets less as the body turns.
Matrix6 RigidBodyStepper::stiffness_of(const Load& load) const {
  const double part = rules_.part();
  const Vector3 force = wrench_of(load).force;
  Matrix6 stiffness = Matrix6::Zero();
  stiffness.bottomRightCorner<3, 3>() = -part * turned_torque(end_arm(load.point), force);
  if (!load.is_local) return stiffness;
  const Eigen::Matrix3d turned_force = part * cross_matrix(end_ * load.force);
  stiffness.topRightCorner<3, 3>() = turned_force;
  stiffness.bottomRightCorner<3, 3>() +=
      cross_matrix(force_arm(load.point)) * turned_force + part * cross_matrix(end_ * load.torque);
  return stiffness;
}

/// At the end, with the mean spin over the substep, or of which that is the mean.
Vector3 RigidBodyStepper::end_momentum() const {
  const double inertia = rules_.inertia();
  return end_ * (whole_.inertia * (inertia / rules_.h * turn_ - (inertia - 1) * spin_));
}

/// V and W over the substep: B^T u / h, and w / h along the body's axes.
Vector6 RigidBodyStepper::mean_rate() const {
  const Vector3 u = way_in_water();
  Vector6 rate;
  rate << start_.transpose() * (u - 0.5 * turn().cross(u)) / rules_.h, turn_ / rules_.h;
  return rate;
}

/// Likewise, with added mass: R' P' and R' L'.
Vector6 RigidBodyStepper::added_end_momentum() const {
  const double inertia = rules_.inertia();
  const Vector6 momentum = inertia_ * (inertia * mean_rate() - (inertia - 1) * rate_);
  Vector6 turned;
  turned << end_ * momentum.head<3>(), end_ * momentum.tail<3>();
  return turned;
}

/// [N], [N m] What changes its momenta so.
Vector6 RigidBodyStepper::momentum_rate() const {
  const double h = rules_.h;
  Vector6 rate;
  if (added_mass_ == 0) {
    const Vector3 start_momentum = start_ * (whole_.inertia * spin_);
    rate << rules_.inertia() * whole_.mass / h * (displacement_ / h - velocity_), (end_momentum() - start_momentum) / h;
    return rate;
  }
  const Vector6 start = inertia_ * rate_, end = added_end_momentum();
  const Vector3 momentum = start_ * start.head<3>();
  rate << (end.head<3>() - momentum) / h, (end.tail<3>() - start_ * start.tail<3>()) / h;
  rate.tail<3>() += way_in_water().cross(0.5 * (momentum + end.head<3>())) / h;
  return rate;
}

Vector6 RigidBodyStepper::load() const {
  const double part = rules_.part(), damping = damping_rate();
  const Vector3 arm = (1 - part) * (start_ * own_) + part * (end_ * own_);
  const Vector3 drag = -linear_damping_ * damping * (displacement_ + (end_ - start_) * own_);
  const Vector3 force = weight() + drag;
  Vector6 load;
  load << force, arm.cross(force) - angular_damping_ * damping * turn();
  if (fluid_.active()) load += fluid_.load(part, way());
  for (const Load* applied : applied_) {
    const Wrench wrench = wrench_of(*applied);
    load.head<3>() += wrench.force;
    load.tail<3>() += wrench.torque;
  }
  return load - momentum_rate();
}

Matrix6 RigidBodyStepper::stiffness() const {
  const double h = rules_.h, inertia = rules_.inertia(), damping = damping_rate();
  const Eigen::Matrix3d along = turned_cayley(turn());
  Matrix6 stiffness = Matrix6::Zero();
  if (added_mass_ > 0) {
    stiffness = momentum_stiffness();
    stiffness.topLeftCorner<3, 3>().diagonal().array() += linear_damping_ * damping;
    stiffness.bottomRightCorner<3, 3>() += angular_damping_ * damping * along;
    stiffness.bottomRightCorner<3, 3>() -= rules_.part() * turned_torque(end_ * own_, weight());
  } else {
    stiffness.topLeftCorner<3, 3>().diagonal().setConstant(inertia * whole_.mass / (h * h) + linear_damping_ * damping);
    stiffness.bottomRightCorner<3, 3>() = inertia / (h * h) * end_ * whole_.inertia * start_.transpose() * along -
                                          cross_matrix(end_momentum()) / h + angular_damping_ * damping * along -
                                          rules_.part() * turned_torque(end_ * own_, weight());
  }
  if (fluid_.active()) stiffness += fluid_.stiffness(rules_.part(), way());
  for (const Load* applied : applied_) stiffness += stiffness_of(*applied);
  return stiffness;
}

/// By what momentum_rate() changes, with added mass.
Matrix6 RigidBodyStepper::momentum_stiffness() const {
  const Vector3 w = turn(), u = way_in_water();
  const Eigen::Matrix3d back = start_.transpose(), along = turned_cayley(w);
  Matrix6 rates, stiffness;
  rates << back - 0.5 * back * cross_matrix(w), 0.5 * back * cross_matrix(u) * along, Eigen::Matrix3d::Zero(), back * along;
  rates *= rules_.inertia() / rules_.h;
  const Vector6 end = added_end_momentum();
  const Matrix6 momenta = inertia_ * rates;
  stiffness << end_ * momenta.topRows<3>(), end_ * momenta.bottomRows<3>();
  stiffness.topRightCorner<3, 3>() -= cross_matrix(end.head<3>());
  stiffness.bottomRightCorner<3, 3>() -= cross_matrix(end.tail<3>());
  const Vector3 momentum = 0.5 * (start_ * (inertia_ * rate_).head<3>() + end.head<3>());
  stiffness.bottomRows<3>() += 0.5 * cross_matrix(u) * stiffness.topRows<3>();
  stiffness.bottomLeftCorner<3, 3>() -= cross_matrix(momentum);
  return stiffness / rules_.h;
}

Matrix6 RigidBodyStepper::inertia() const {
  Matrix6 inertia = Matrix6::Zero();
  if (added_mass_ == 0) {
    inertia.topLeftCorner<3, 3>().diagonal().setConstant(whole_.mass);
    inertia.bottomRightCorner<3, 3>() = end_ * whole_.inertia * end_.transpose();
    return inertia;
  }
  for (const int row : {0, 3})
    for (const int column : {0, 3})
      inertia.block<3, 3>(row, column) = end_ * inertia_.block<3, 3>(row, column) * end_.transpose();
  return inertia;
}

void RigidBodyStepper::correct(const Vector6& change) {
  displacement_ += change.head<3>();
  turn_by(cayley(change.tail<3>()) * end_orientation_);
}

Vector3 RigidBodyStepper::end_velocity() const {
  if (rules_.statics) return Vector3::Zero();
  const VelocityWeights weights = velocity_weights(rules_.scheme);
  if (added_mass_ > 0)
    return fluid_.flow() +
           end_ * (weights.displacement * mean_rate() + weights.velocity * rate_ + weights.acceleration * rules_.h * rate_change_)
                      .head<3>();
  return weights.displacement / rules_.h * displacement_ + weights.velocity * velocity_ +
         weights.acceleration * rules_.h * acceleration_;
}

Vector3 RigidBodyStepper::end_spin() const {
  if (rules_.statics) return Vector3::Zero();
  const VelocityWeights weights = velocity_weights(rules_.scheme);
  return weights.displacement / rules_.h * turn_ + weights.velocity * spin_ + weights.acceleration * rules_.h * spin_change_;
}

double RigidBodyStepper::damping_work() const {
  return damping_rate() *
         (linear_damping_ * (displacement_ + (end_ - start_) * own_).squaredNorm() + angular_damping_ * turn_.squaredNorm());
}

void RigidBodyStepper::add_fluid_work(EnergyBalance& balance) const {
  if (fluid_.active()) fluid_.add_work(rules_.part(), way(), balance);
}

double RigidBodyStepper::applied_work() const {
  double work = 0;
  for (const Load* applied : applied_) {
    const Wrench wrench = wrench_of(*applied);
    work += wrench.force.dot(displacement_) + wrench.torque.dot(turn());
  }
  return work;
}

void RigidBodyStepper::expect_momenta(GroupMomenta& group) const {
  group.expect(whole_.mass, center_, displacement_, velocity_, rules_.inertia() * (displacement_ / rules_.h - velocity_));
  group.expect_spin(end_momentum());
}

void RigidBodyStepper::add_momenta(GroupMomenta& group) const {
  group.add(whole_.mass, center_ + displacement_, end_velocity());
  group.add_spin(end_ * whole_.inertia * end_.transpose(), end_ * (whole_.inertia * end_spin()));
}

Vector3 RigidBodyStepper::velocity_of(const Vector3& point) const {
  return end_velocity() + (end_ * end_spin()).cross(end_arm(point));
}

void RigidBodyStepper::finish(SimulatedBody& body, BodyProgress& progress) const {
  const double h = rules_.h;
  body.pose = pose();
  body.velocity = velocity_of(body.center_of_mass);
  body.angular_velocity = end_ * end_spin();
  progress.acceleration = progress.angular_acceleration = Vector3::Zero();
  if (rules_.statics) return;
  progress.acceleration = (end_velocity() - velocity_) / h;
  progress.angular_acceleration = (end_spin() - spin_) / h;
  if (rules_.scheme != Scheme::damped) return;
  progress.acceleration = (displacement_ / h - velocity_) / h + 0.5 * acceleration_;
  progress.angular_acceleration = (turn_ / h - spin_) / h + 0.5 * spin_change_;
  if (added_mass_ == 0) return;
  const Vector3 change = ((mean_rate() - rate_) / h + 0.5 * rate_change_).head<3>();
  progress.acceleration = end_ * (change + end_spin().cross(end_.transpose() * (end_velocity() - fluid_.flow())));
}

}  // namespace verlet_cable

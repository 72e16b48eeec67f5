#include "body/body_fluid_forces.h"

#include <algorithm>
#include <cmath>

namespace verlet_cable {

namespace {

/// |v| c v, with a coefficient for each axis: the same about all axes where the coefficients are.
Vector3 quadratic(const Vector3& coefficients, const Vector3& v) {
  return v.norm() * coefficients.cwiseProduct(v);
}

/// By which that changes with v.
Eigen::Matrix3d quadratic_slope(const Vector3& coefficients, const Vector3& v) {
  Eigen::Matrix3d slope = (v.norm() * coefficients).asDiagonal();
  if (v.norm() > 0) slope += coefficients.cwiseProduct(v) * v.transpose() / v.norm();
  return slope;
}

}  // namespace

void BodyFluidForces::begin(const BodyFluidDesc& body, const Environment& environment, double middle, double h, bool statics,
                            const Vector3& center, const Vector3& velocity, const Vector3& arm) {
  const FluidDesc& fluid = environment.fluid;
  active_ = fluid.density > 0 &&
            (body.volume > 0 || !body.drag_area.isZero(0) || !body.angular_drag.isZero(0) || !body.added_mass.isZero(0));
  flow_.setZero();
  if (!active_) return;
  body_ = body;
  statics_ = statics;
  density_ = fluid.density;
  h_ = h;
  rate_ = statics ? 0 : 1 / h;
  radius_ = std::cbrt(0.75 / M_PI * body.volume);
  arm_ = arm;
  const Vector3 place = center + 0.5 * h * velocity;
  gravity_ = environment.gravity.at(place);
  water_ = environment.water_at(place, middle);
  depth_ = water_.surface - center.z();
  is_wet_ = water_.surface - place.z() > -radius_;
  if (is_wet_ && !statics) flow_ = water_.velocity;
}

/// The cap of a sphere [m^3]; of what has no volume, whether it is in the water.
double BodyFluidForces::volume_below(double depth) const {
  if (radius_ == 0) return is_wet_ ? 1 : 0;
  const double height = std::clamp(radius_ + depth, 0.0, 2 * radius_);
  return M_PI / 3 * height * height * (3 * radius_ - height);
}

double BodyFluidForces::area_at(double depth) const {
  return M_PI * std::max(0.0, radius_ * radius_ - depth * depth);
}

Eigen::Matrix3d BodyFluidForces::added_mass(const Eigen::Matrix3d& axes) const {
  return axes * body_.added_mass.asDiagonal() * axes.transpose();
}

BodyFluidForces::Forces BodyFluidForces::forces(double part, const BodyWay& way) const {
  Forces f;
  f.axes = (1 - part) * way.start + part * way.end;
  f.displacement = way.displacement + (way.end - way.start) * arm_;
  f.against = f.axes.transpose() * (water_.velocity - rate_ * f.displacement);
  f.spin = rate_ * (way.end.transpose() * way.turn);
  const double depth = depth_ - f.displacement.z(), whole = radius_ == 0 ? 1 : body_.volume;
  if (statics_) {
    f.immersed = volume_below(depth);
    f.immersion = area_at(depth);
  } else {
    // Simpson's rule is exact for caps.
    const double middle = 0.5 * (depth_ + depth);
    f.immersed = (volume_below(depth_) + 4 * volume_below(middle) + volume_below(depth)) / 6;
    f.immersion = (2 * area_at(middle) + area_at(depth)) / 6;
  }
  f.part = std::min(1.0, f.immersed / whole);
  f.drag = f.axes * (0.5 * density_ * quadratic(body_.drag_area, f.against));
  f.torque = -(f.axes * quadratic(body_.angular_drag, f.spin));
  f.pressure = density_ * body_.volume * (water_.acceleration - gravity_);
  const Eigen::Matrix3d mass = added_mass(f.axes);
  f.carried = is_wet_ ? Vector3(mass * water_.acceleration) : Vector3(Vector3::Zero());
  f.static_torque = statics_ && is_wet_ ? Vector3(-water_.velocity.cross(mass * water_.velocity)) : Vector3(Vector3::Zero());
  return f;
}

Vector6 BodyFluidForces::load(double part, const BodyWay& way) const {
  const Forces f = forces(part, way);
  Vector6 load;
  load << f.force(), (f.axes * arm_).cross(f.force()) + f.part * f.torque + f.static_torque;
  return load;
}

Matrix6 BodyFluidForces::stiffness(double part, const BodyWay& way) const {
  const Forces f = forces(part, way);
  const Eigen::Matrix3d drag =
      0.5 * f.part * density_ * f.axes * quadratic_slope(body_.drag_area, f.against) * f.axes.transpose();
  const double whole = radius_ == 0 ? 1 : body_.volume;
  // Of the force, by a displacement of C, and as the axes turn
  Eigen::Matrix3d moved = -rate_ * drag, turned = -cross_matrix(f.part * f.drag) + drag * cross_matrix(f.axes * f.against);
  moved.col(2) -= f.immersion / whole * (f.drag + f.pressure);
  const Eigen::Matrix3d mass = added_mass(f.axes);
  const auto turning = [&](const Vector3& of) { return Eigen::Matrix3d(mass * cross_matrix(of) - cross_matrix(mass * of)); };
  if (is_wet_) turned += turning(water_.acceleration);
  const Vector3 arm = f.axes * arm_, end_arm = way.end * arm_;
  Eigen::Matrix<double, 3, 6> force;
  force << moved, part * turned - moved * cross_matrix(end_arm);
  Matrix6 stiffness;
  stiffness.topRows<3>() = -force;
  stiffness.bottomRows<3>() = -cross_matrix(arm) * force;
  stiffness.bottomRightCorner<3, 3>() -= part * turned_torque(end_arm, f.force());
  stiffness.bottomRightCorner<3, 3>() +=
      rate_ * f.part * f.axes * quadratic_slope(body_.angular_drag, f.spin) * way.end.transpose();
  if (statics_ && is_wet_) stiffness.bottomRightCorner<3, 3>() += cross_matrix(water_.velocity) * turning(water_.velocity);
  return stiffness;
}

void BodyFluidForces::add_work(double part, const BodyWay& way, EnergyBalance& balance) const {
  const Forces f = forces(part, way);
  const Vector3 flow = h_ * water_.velocity;
  const double turning = -f.part * f.torque.dot(way.turn);
  balance.dissipated.drag += f.part * f.drag.dot(flow - f.displacement) + turning;
  balance.work.applied += f.part * f.drag.dot(flow) + (f.part * f.pressure + f.carried).dot(f.displacement);
  // Added mass that turns in a current.
  balance.work.applied += 0.5 * flow_.dot((added_mass(way.end) - added_mass(way.start)) * flow_);
}

}  // namespace verlet_cable

#include "contact/law.h"

#include <algorithm>
#include <cmath>

namespace verlet_cable {

namespace {

/// Pressed by a force F, a cable of radius r is dented by about r sqrt(F / (contact_modulus r²)): like rubber.
constexpr double contact_modulus = 1e8;  // [Pa]
/// Beyond this depth, relative to the radius, it gets much stiffer, so that no load presses it flat.
constexpr double soft_depth = 0.06;
/// The law goes on linearly from here, relative to the radius.
constexpr double deepest = 0.18;
/// What is inside an obstacle is pushed out at no more than about this.
constexpr double gentle_velocity = 0.5;  // [m/s]
/// Stiffness of a contact without load, relative to what stops a mass within a step.
constexpr double stopping_part = 2;
/// Steps within which a contact comes to rest.
constexpr double contact_steps = 2;
/// A linearisation is as good as the law if the forces differ by no more than this, relatively.
constexpr double linear_enough = 0.05;
/// And if its slope differs from the law's by no more than this, relatively.
constexpr double slope_enough = 0.3;
/// Relative, of depths between which a secant is taken.
constexpr double least_secant = 1e-3;
/// [radii] By which a side of a soft section can be pressed in; then it is as stiff as any.
constexpr double softest_depth = 0.8;
/// With which friction across two oblique cables that roll is found.
constexpr int oblique_passes = 8;

struct ForceAndSlope {
  double force = 0, slope = 0;
};

/// Of a depth [m], >= 0.
ForceAndSlope stiff_law(double depth, const Touch& touch) {
  const double x = std::min(depth / touch.radius, deepest), y = x / soft_depth, y4 = y * y * y * y;
  // What cannot get apart is not torn apart.
  const double scale = touch.yields ? 0 : contact_modulus * touch.radius;
  const double slope = touch.base_stiffness + scale * x * (2 + 6 * y4);
  const double force = touch.base_stiffness * x * touch.radius + scale * touch.radius * x * x * (1 + y4);
  return {touch.share * (force + slope * (depth - x * touch.radius)), touch.share * slope};
}

/// What cannot get apart presses with the stiff law alone, as gently as that is then.
bool is_soft(const Touch& touch) {
  return touch.soft_stiffness < infinity && !touch.yields;
}

/// Of a depth [m], >= 0.
ForceAndSlope depth_law(double depth, const Touch& touch) {
  if (!is_soft(touch)) return stiff_law(depth, touch);
  const double soft = touch.soft_stiffness;
  if (depth <= touch.soft_depth) return {soft * depth, soft};
  const ForceAndSlope stiff = stiff_law(depth - touch.soft_depth, touch);
  return {soft * depth + stiff.force, soft + stiff.slope};
}

/// [m] At which the stiff law has a force [N], within some percent.
double stiff_depth_of(double force, const Touch& touch) {
  const double scaled = force / (touch.share * contact_modulus * touch.radius * touch.radius);
  double depth = touch.radius * std::min(std::sqrt(scaled), std::cbrt(std::sqrt(scaled) * soft_depth * soft_depth));
  if (depth > deepest * touch.radius) depth = force / stiff_law(deepest * touch.radius, touch).force * deepest * touch.radius;
  for (int i = 0; i < 2; ++i) {
    const ForceAndSlope law = stiff_law(depth, touch);
    depth += (force - law.force) / law.slope;
  }
  return std::max(depth, 0.0);
}

/// [m] At which the law has a force [N], likewise.
double depth_of(double force, const Touch& touch) {
  if (!is_soft(touch)) return stiff_depth_of(force, touch);
  const double beyond = force - touch.soft_stiffness * touch.soft_depth;
  if (beyond <= 0) return force / touch.soft_stiffness;
  double depth = touch.soft_depth + stiff_depth_of(beyond, touch);
  for (int i = 0; i < 2; ++i) {
    const ForceAndSlope law = depth_law(depth, touch);
    depth += (force - law.force) / law.slope;
  }
  return std::max(depth, touch.soft_depth);
}

/// [N/m] With which the law is linearised at a depth, where cables have come to press with a force [N] by the linearisation
/// before. Along its tangent the law is walked down in steps of a sixth, as it grows with the sixth power; the force that the
/// cables press with hardly changes meanwhile, so that the secant to the depth of that force leads there at once.
double secant(double depth, const ForceAndSlope& law, double pressing_force, const Touch& touch) {
  if (!(pressing_force > 0)) return law.slope;
  const double wanted = depth_of(pressing_force, touch), way = depth - wanted;
  if (std::abs(way) <= least_secant * depth) return law.slope;
  return (law.force - depth_law(wanted, touch).force) / way;
}

/// Friction whose part across each cable that rolls is no more than this may be.
Vector3 rolled(Vector3 friction, double limit, const Touch& touch) {
  const int passes = touch.rolling_count > 1 ? oblique_passes : 1;
  for (int pass = 0; pass < passes; ++pass)
    for (int k = 0; k < touch.rolling_count; ++k) {
      const Rolling& rolling = touch.rolling[k];
      const double along = friction.dot(rolling.across), most = rolling.part * limit;
      friction -= (along - std::clamp(along, -most, most)) * rolling.across;
    }
  return friction;
}

/// The friction of what would take `trial` [N] to stick, at most `limit` [N]. Where cables roll, it is that which takes most work
/// from the slip among all that is small enough: along a cable that rolls nothing is lost.
Vector3 bounded(const Vector3& trial, double limit, const Touch& touch) {
  const double size = trial.norm();
  const Vector3 scaled = size <= limit ? trial : Vector3(limit / size * trial);
  if (touch.rolling_count == 0) return scaled;
  const Vector3 least = rolled(scaled, limit, touch), way = rolled(trial, limit, touch) - least;
  const double square = way.squaredNorm(), room = limit * limit - least.squaredNorm(), product = way.dot(least);
  if (!(square > 0) || !(room > 0)) return least;
  return least + std::min(1.0, (std::sqrt(product * product + square * room) - product) / square) * way;
}

/// Sets which parts of `trial` [N] are left of it, along what rolls and across.
void set_parts(const Vector3& trial, const Vector3& friction, double part, Touch& touch) {
  touch.part = touch.rolling_part = part;
  if (touch.rolling_count == 0) return;
  const auto of = [&](const Vector3& axis) {
    const double whole = axis.dot(trial);
    return whole != 0 ? std::clamp(axis.dot(friction) / whole, 0.0, 1.0) : part;
  };
  touch.across = touch.rolling[0].across;
  for (int k = 1; k < touch.rolling_count; ++k)
    if (of(touch.rolling[k].across) < of(touch.across)) touch.across = touch.rolling[k].across;
  touch.part = of(touch.normal.cross(touch.across));
  touch.rolling_part = of(touch.across);
}

/// [N] Tension presses as it did in the substep before, and its turn leans that much; what strikes presses along the normal:
/// leaning it would do work on what slides.
Vector3 leaning_force(const Touch& touch) {
  return std::min(touch.bound, touch.last_force) * touch.lean;
}

}  // namespace

double stopping_stiffness(double mass, double time_step) {
  return stopping_part * mass / (time_step * time_step);
}

double contact_time(double time_step) {
  return contact_steps * time_step;
}

void anticipate(Scheme scheme, double h, double contact_time, const Vector3& acceleration, Touch& touch) {
  const VelocityWeights weights = velocity_weights(scheme);
  const SurfaceMotion& other = touch.other_motion;
  const Vector3 velocity = lagging_velocity(scheme, h, other.displacement, other.end_velocity);
  const Vector3 known = weights.velocity * touch.velocity + weights.acceleration * h * acceleration;
  touch.rate = 1 + weights.displacement * contact_time / h;
  touch.offset = other.displacement + contact_time * (velocity - known);
}

double gentle_gap(double radius, double contact_time) {
  return -std::clamp(gentle_velocity * contact_time, 0.05 * radius, 0.15 * radius);
}

double force_of_depth(double depth, const Touch& touch) {
  return depth > 0 ? depth_law(depth, touch).force / touch.share : 0;
}

void soften(double stiffness, Touch& touch) {
  touch.soft_stiffness = stiffness;
  touch.soft_depth = softest_depth * touch.radius;
}

void start_touch(Touch& touch) {
  touch.depth = std::max(0.0, -touch.gap);
  const ForceAndSlope law = depth_law(touch.depth, touch);
  touch.depth_force = law.force;
  touch.stiffness = touch.normal_stiffness = law.slope;
}

bool evaluate_touch(const Vector3& w, Touch& touch) {
  touch.displacement = w;
  const Vector3 e = touch.rate * w - touch.offset;
  const double along = touch.normal.dot(e), depth = -touch.gap - along;
  const Touch::Mode before = touch.mode;
  if (depth <= 0) {
    touch.mode = Touch::Mode::open;
    touch.normal_force = 0;
    touch.force.setZero();
    return before != touch.mode;
  }
  const ForceAndSlope law = depth_law(depth, touch);
  const double linear_force = touch.depth_force + touch.stiffness * (depth - touch.depth);
  const bool bent = std::abs(linear_force - law.force) > linear_enough * law.force ||
                    std::abs(touch.stiffness - law.slope) > slope_enough * law.slope;
  if (bent) {
    touch.stiffness = secant(depth, law, linear_force, touch);
    touch.depth = depth;
    touch.depth_force = law.force;
  }
  touch.normal_force = law.force;
  touch.normal_stiffness = bent ? touch.stiffness : law.slope;
  Vector3 trial = touch.stuck_force - touch.stiffness * e;
  trial -= touch.normal.dot(trial) * touch.normal;
  if (!touch.bound_is_held) touch.bound = touch.normal_force;
  const Vector3 lean = leaning_force(touch);
  trial -= lean;
  const double size = trial.norm(), limit = touch.friction * touch.bound;
  const Vector3 friction = bounded(trial, limit, touch);
  const bool sticks = size <= limit && friction == trial;
  touch.mode = sticks ? Touch::Mode::sticks : Touch::Mode::slides;
  set_parts(trial, friction, size <= limit ? 1 : limit / size, touch);
  touch.force = touch.normal_force * touch.normal + lean + friction;
  return bent || before != touch.mode;
}

Eigen::Matrix3d slope(const Touch& touch) {
  const double stiffness = touch.rate * touch.stiffness;
  Eigen::Matrix3d slope =
      (touch.rate * touch.normal_stiffness - stiffness * touch.part) * touch.normal * touch.normal.transpose();
  slope.diagonal().array() += stiffness * touch.part;
  if (touch.rolling_count > 0) {
    slope += stiffness * (touch.rolling_part - touch.part) * touch.across * touch.across.transpose();
  } else if (touch.bound_is_held && touch.mode == Touch::Mode::slides) {
    const Vector3 friction = touch.force - touch.normal_force * touch.normal - leaning_force(touch);
    if (!friction.isZero(0)) slope -= stiffness * touch.part / friction.squaredNorm() * friction * friction.transpose();
  }
  return slope;
}

Vector3 corrected_force(const Touch& touch) {
  return touch.force + touch.followed - slope(touch) * touch.correction;
}

Vector3 following_friction(const Touch& touch) {
  if (touch.bound_is_held) return Vector3::Zero();
  const Vector3 lean = touch.bound < touch.last_force ? touch.lean : Vector3(Vector3::Zero());
  if (touch.mode != Touch::Mode::slides) return lean;
  return lean + (touch.force - leaning_force(touch)) / touch.normal_force - touch.normal;
}

Eigen::Matrix3d full_slope(const Touch& touch) {
  return slope(touch) + touch.rate * touch.normal_stiffness * following_friction(touch) * touch.normal.transpose();
}

Vector3 remaining_friction(const Touch& touch) {
  if (touch.mode == Touch::Mode::open) return Vector3::Zero();
  const Vector3 slip = touch.displacement - touch.other_motion.displacement;
  Vector3 force = touch.stuck_force - touch.stiffness * slip;
  force -= touch.normal * touch.normal.dot(force);
  const Vector3 lean = leaning_force(touch);
  if (touch.mode == Touch::Mode::slides) force = lean + bounded(force - lean, touch.friction * touch.bound, touch);
  return half_turned(touch, force);
}

}  // namespace verlet_cable

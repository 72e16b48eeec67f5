#include "rod/rod_joints.h"

#include <algorithm>
#include <cmath>

#include "law/angle_energy.h"
#include "law/resistance.h"
#include "rod/outer_products.h"

namespace verlet_cable {

namespace {

/// Of 1 - u / 2: a cable that is folded back on itself bends about no axis.
constexpr double smallest_turn = 1e-6;
/// Up to here [rad] series are exact.
constexpr double small_turn = 0.05;
constexpr double small_half_twist = 0.25;

/// Products of the axes of neighbouring frames.
struct Products {
  Pair u, y, z, sine, cosine;
};

Products products(const PairFrame& a, const PairFrame& b) {
  return {1.0 - dot(a.x, b.x), -dot(a.z, b.x), dot(a.y, b.x), dot(a.z, b.y) - dot(a.y, b.z), dot(a.y, b.y) + dot(a.z, b.z)};
}

Pair half_turn_left(Pair u) {
  const Pair left = 1.0 - 0.5 * u;
  return Pair{std::max(left[0], smallest_turn), std::max(left[1], smallest_turn)};
}

/// angle / sin(angle)
Pair chi(Pair u) {
  return square_root(relative_angle_energy(u) / half_turn_left(u));
}

/// (chi(b) - chi(a)) / (b - a)
Pair mean_chi_slope(Pair a, Pair chi_a, Pair b, Pair chi_b) {
  const Pair left_a = half_turn_left(a), left_b = half_turn_left(b);
  const Pair energy_slope = 1.0 / 6 + 2.0 / 45 * (a + b) + 1.0 / 70 * (a * a + a * b + b * b);
  const Pair energies = relative_angle_energy(a) + relative_angle_energy(b);
  return (0.5 * (left_a + left_b) * energy_slope + 0.25 * energies) / (left_a * left_b * (chi_a + chi_b));
}

/// The second derivative of chi. `slope`: the first.
Pair chi_curvature(Pair u, Pair chi, Pair slope) {
  const Pair left = half_turn_left(u), energy = relative_angle_energy(u);
  const Pair energy_slope = 1.0 / 6 + u * (4.0 / 45 + u * (3.0 / 70)), energy_curvature = 4.0 / 45 + u * (6.0 / 70);
  const Pair of_square = (energy_curvature + (energy_slope + 0.5 * energy / left) / left) / left;  // of chi²
  return (0.5 * of_square - slope * slope) / chi;
}

struct Turn {
  Pair angle;     ///< atan2(sine, cosine)
  Pair quotient;  ///< angle / sine
};

Turn turn(Pair sine, Pair cosine) {
  const Pair r = sine / cosine, r2 = r * r;
  const Pair series = 1.0 - r2 * (1.0 / 3 - r2 * (1.0 / 5 - r2 * (1.0 / 7 - r2 * (1.0 / 9 - r2 * (1.0 / 11)))));
  Turn result{r * series, series / cosine};
  for (int lane = 0; lane < 2; ++lane) {
    if (r2[lane] < small_turn * small_turn && cosine[lane] > 0) continue;
    const double angle = std::atan2(sine[lane], cosine[lane]);
    result.angle[lane] = angle;
    result.quotient[lane] = sine[lane] != 0 ? angle / sine[lane] : 1 / cosine[lane];
  }
  return result;
}

/// tan(x) / x
Pair relative_tangent(Pair x) {
  const Pair x2 = x * x;
  Pair result = 1.0 + x2 * (1.0 / 3 + x2 * (2.0 / 15 + x2 * (17.0 / 315 + x2 * (62.0 / 2835))));
  for (int lane = 0; lane < 2; ++lane)
    if (!(x2[lane] < small_turn * small_turn)) result[lane] = std::tan(x[lane]) / x[lane];
  return result;
}

struct SineCosine {
  Pair sine, cosine;
};

SineCosine half_angle(Pair twist) {
  const Pair x = 0.5 * twist, x2 = x * x;
  SineCosine result;
  result.sine = x * (1.0 - x2 / 6.0 * (1.0 - x2 / 20.0 * (1.0 - x2 / 42.0 * (1.0 - x2 / 72.0 * (1.0 - x2 / 110.0)))));
  result.cosine =
      1.0 - x2 / 2.0 * (1.0 - x2 / 12.0 * (1.0 - x2 / 30.0 * (1.0 - x2 / 56.0 * (1.0 - x2 / 90.0 * (1.0 - x2 / 132.0)))));
  for (int lane = 0; lane < 2; ++lane) {
    if (x2[lane] < small_half_twist * small_half_twist) continue;
    result.sine[lane] = std::sin(x[lane]);
    result.cosine[lane] = std::cos(x[lane]);
  }
  return result;
}

}  // namespace

void FrameArrays::resize(std::size_t count) {
  for (VectorArray* axis : {&x, &y, &z}) axis->assign(count, 0.0);
  std::fill(x.x.begin(), x.x.end(), 1.0);
  std::fill(y.y.begin(), y.y.end(), 1.0);
  std::fill(z.z.begin(), z.z.end(), 1.0);
}

void FrameMotion::resize(std::size_t count) {
  for (FrameArrays* frames : {&start, &end, &middle}) frames->resize(count);
}

JointAngles joint_angles(const Eigen::Matrix3d& before, const Eigen::Matrix3d& after, double twist) {
  const Eigen::Matrix3d q = before.transpose() * after;
  const double measured = std::atan2(q(2, 1) - q(1, 2), q(1, 1) + q(2, 2));
  JointAngles angles;
  angles.twist = twist + std::remainder(measured - twist, 2 * M_PI);
  const double scale = chi(both(1 - q(0, 0)))[0], y = -q(2, 0), z = q(1, 0);
  const double cosine = std::cos(0.5 * angles.twist), sine = std::sin(0.5 * angles.twist);
  angles.y = scale * (cosine * y + sine * z);
  angles.z = scale * (cosine * z - sine * y);
  return angles;
}

JointEnergy joint_energy(const JointStiffness& stiffness, const JointAngles& angles) {
  const double twist = angles.twist - stiffness.rest.twist, y = angles.y - stiffness.rest.y, z = angles.z - stiffness.rest.z;
  const auto energy = [](double resistance, double strain) { return Resistance<double>{resistance, 0}.energy(strain); };
  JointEnergy sum{energy(stiffness.bend_y, y) + energy(stiffness.bend_z, z), energy(stiffness.twist, twist)};
  for (const SlidingSpring* spring : {&stiffness.yielding, &stiffness.friction})
    sum.bend += spring->energy(strain_of(*spring, stiffness.rest, angles));
  sum.bend -= stiffness.yielding.energy({y, z});
  return sum;
}

AboutAxes strain_of(const SlidingSpring& spring, const JointAngles& rest, const JointAngles& angles) {
  return AboutAxes{angles.y - rest.y, angles.z - rest.z} - spring.slid;
}

void RodJoints::resize(int count) {
  const std::size_t size = count + 1;
  for (std::vector<double>* a :
       {&twist_stiffness_, &y_stiffness_, &z_stiffness_, &twist_damping_, &bend_damping_, &rest_twist_, &rest_y_, &rest_z_,
        &twist_, &u_, &y_, &z_, &sine_, &cosine_, &chi_, &half_sine_, &half_cosine_, &end_twist_})
    a->assign(size, 0.0);
  bending_loss.assign(size, 0.0);
  twisting_loss.assign(size, 0.0);
  sliding_loss.assign(size, 0.0);
  for (std::vector<SlidingSpring>* springs : {&yielding_, &friction_}) springs->assign(size, {});
  memory_.assign(size, {});
  for (std::vector<AboutAxes>* slid : {&end_yielded_, &end_slipped_}) slid->assign(size, {});
  moment.assign(size, 0.0);
  convex_stiffness.assign(size, 0.0);
  exact_stiffness.assign(size, 0.0);
}

void RodJoints::set(int joint, const JointStiffness& stiffness, double twist) {
  set_stiffness(joint, stiffness);
  twist_[joint] = twist;
  if (!slides_) return;
  yielding_[joint].slid = stiffness.yielding.slid;
  friction_[joint].slid = stiffness.friction.slid;
  memory_[joint] = {stiffness.yielding.slid, stiffness.friction.slid, {}, {}, 0};
}

void RodJoints::set_stiffness(int joint, const JointStiffness& stiffness) {
  twist_stiffness_[joint] = stiffness.twist;
  y_stiffness_[joint] = stiffness.bend_y;
  z_stiffness_[joint] = stiffness.bend_z;
  twist_damping_[joint] = stiffness.twist_damping;
  bend_damping_[joint] = stiffness.bend_damping;
  rest_twist_[joint] = stiffness.rest.twist;
  rest_y_[joint] = stiffness.rest.y;
  rest_z_[joint] = stiffness.rest.z;
  if (!slides_) return;
  const auto set = [](const SlidingSpring& from, SlidingSpring& to) {
    to = {from.y_stiffness, from.z_stiffness, from.limit, to.slid};
  };
  set(stiffness.yielding, yielding_[joint]);
  set(stiffness.friction, friction_[joint]);
}

void RodJoints::start(const FrameArrays& frames_before, int before, const FrameArrays& frames_after, int after, int first,
                      int last) {
  for (int i = first, k = 0; i < last; i += 2, k += 2) {
    const Products q = products(neighbours(frames_before, before + k), neighbours(frames_after, after + k));
    Pair twist = neighbours(twist_, i);
    SineCosine half = half_angle(twist);
    const Pair cosine = half.cosine * half.cosine - half.sine * half.sine, sine = 2.0 * half.sine * half.cosine;
    twist += turn(q.sine * cosine - q.cosine * sine, q.cosine * cosine + q.sine * sine).angle;
    half = half_angle(twist);
    put(twist, twist_, i);
    put(q.u, u_, i);
    put(q.y, y_, i);
    put(q.z, z_, i);
    put(q.sine, sine_, i);
    put(q.cosine, cosine_, i);
    put(chi(q.u), chi_, i);
    put(half.sine, half_sine_, i);
    put(half.cosine, half_cosine_, i);
    if (!slides_ || slides_from_memory_) continue;
    const Pair scale = chi(q.u);
    const Pair strain_y = scale * (half.cosine * q.y + half.sine * q.z) - neighbours(rest_y_, i);
    const Pair strain_z = scale * (half.cosine * q.z - half.sine * q.y) - neighbours(rest_z_, i);
    for (int lane = 0; lane < 2 && i + lane < last; ++lane) slide_at_once(i + lane, {strain_y[lane], strain_z[lane]});
  }
}

/// `strain` [rad]: the joint's angles at the start beyond those at rest.
void RodJoints::slide_at_once(int joint, const AboutAxes& strain) {
  for (SlidingSpring* spring : {&yielding_[joint], &friction_[joint]}) {
    const AboutAxes found = strain - spring->slid, left = spring->slide(found).strain;
    memory_[joint].loss += spring->energy(found) - spring->energy(left);
    spring->slid = spring->slid + (found - left);
  }
}

/// What springs that slide add to moments and stiffnesses over the substep.
struct RodJoints::Slid {
  AboutAxes moment;               ///< [N m]
  double yy = 0, yz = 0, zz = 0;  ///< [N m / rad]
};

/// `start` [rad]: the joint's angles beyond those at rest; `change`: of them, over the substep.
RodJoints::Slid RodJoints::slide(int joint, double part, const AboutAxes& start, const AboutAxes& change) {
  Slid sum;
  sliding_loss[joint] = memory_[joint].loss;
  const auto add = [&](const SlidingSpring& spring, const AboutAxes& brought, AboutAxes& end_slid) {
    const AboutAxes before = start - spring.slid, tried = before + change - brought;
    const Slide after = spring.slide(tried);
    const AboutAxes slid = tried - after.strain, moment = spring.moment(before + part * (after.strain - before));
    end_slid = spring.slid + slid;
    sliding_loss[joint] += dot(moment, slid);
    sum.moment = sum.moment + moment;
    sum.yy += part * after.yy;
    sum.yz += part * after.yz;
    sum.zz += part * after.zz;
  };
  const SlidingSpring& yielding = yielding_[joint];
  add(yielding, memory_[joint].brought_yielded, end_yielded_[joint]);
  add(friction_[joint], memory_[joint].brought_slipped, end_slipped_[joint]);
  // What yields is a part of the joint's bending stiffness.
  sum.moment = sum.moment - yielding.moment(start + part * change);
  sum.yy -= part * yielding.y_stiffness;
  sum.zz -= part * yielding.z_stiffness;
  return sum;
}

void RodJoints::evaluate(double part, const FrameMotion& frames_before, int before, const FrameMotion& frames_after, int after,
                         int first, int last) {
  if (slides_)
    evaluate_joints<true>(part, frames_before, before, frames_after, after, first, last);
  else
    evaluate_joints<false>(part, frames_before, before, frames_after, after, first, last);
}

template <bool slides>
void RodJoints::evaluate_joints(double part, const FrameMotion& frames_before, int before, const FrameMotion& frames_after,
                                int after, int first, int last) {
  for (int i = first, k = 0; i < last; i += 2, k += 2) {
    const Products end = products(neighbours(frames_before.end, before + k), neighbours(frames_after.end, after + k));
    Products start{neighbours(u_, i), neighbours(y_, i), neighbours(z_, i), neighbours(sine_, i), neighbours(cosine_, i)};
    Pair start_chi = neighbours(chi_, i), half_sine = neighbours(half_sine_, i), half_cosine = neighbours(half_cosine_, i);
    const Pair end_chi = chi(end.u), start_twist = neighbours(twist_, i);

    // The change of twist, and the halves of the twist at the end.
    Turn change = turn(end.sine * start.cosine - start.sine * end.cosine, end.cosine * start.cosine + end.sine * start.sine);
    const Pair end_twist = start_twist + change.angle;
    put(end_twist, end_twist_, i);
    Pair tangent_quotient = relative_tangent(0.25 * change.angle);
    const Pair tangent = 0.25 * change.angle * tangent_quotient, scale = 1.0 / (1.0 + tangent * tangent);
    const Pair turned_cosine = (1.0 - tangent * tangent) * scale, turned_sine = 2.0 * tangent * scale;
    const Pair end_half_cosine = half_cosine * turned_cosine - half_sine * turned_sine;
    const Pair end_half_sine = half_sine * turned_cosine + half_cosine * turned_sine;

    const Pair angle_change_y =
        end_chi * (end_half_cosine * end.y + end_half_sine * end.z) - start_chi * (half_cosine * start.y + half_sine * start.z);
    const Pair angle_change_z =
        end_chi * (end_half_cosine * end.z - end_half_sine * end.y) - start_chi * (half_cosine * start.z - half_sine * start.y);
    Pair slid_y{}, slid_z{}, slid_yy{}, slid_yz{}, slid_zz{};
    if constexpr (slides) {
      const Pair strain_y = start_chi * (half_cosine * start.y + half_sine * start.z) - neighbours(rest_y_, i);
      const Pair strain_z = start_chi * (half_cosine * start.z - half_sine * start.y) - neighbours(rest_z_, i);
      for (int lane = 0; lane < 2; ++lane) {
        const Slid slid = slide(i + lane, part, {strain_y[lane], strain_z[lane]}, {angle_change_y[lane], angle_change_z[lane]});
        slid_y[lane] = slid.moment.y;
        slid_z[lane] = slid.moment.z;
        slid_yy[lane] = slid.yy;
        slid_yz[lane] = slid.yz;
        slid_zz[lane] = slid.zz;
      }
    }
    if (part == 1) {
      // Forces are those of the end: quotients of differences become derivatives.
      start = end;
      start_chi = end_chi;
      half_sine = end_half_sine;
      half_cosine = end_half_cosine;
      change.quotient = 1.0 / (end.cosine * end.cosine + end.sine * end.sine);
      tangent_quotient = both(1);
    }

    const Pair start_y = half_cosine * start.y + half_sine * start.z, start_z = half_cosine * start.z - half_sine * start.y;
    const Pair end_y = end_half_cosine * end.y + end_half_sine * end.z, end_z = end_half_cosine * end.z - end_half_sine * end.y;

    // Means
    const Pair mean_chi = 0.5 * (start_chi + end_chi), chi_slope = mean_chi_slope(start.u, start_chi, end.u, end_chi);
    const Pair y = 0.5 * (start.y + end.y), z = 0.5 * (start.z + end.z);
    const Pair sine = 0.5 * (start.sine + end.sine), cosine = 0.5 * (start.cosine + end.cosine);
    const Pair c = 0.5 * (half_cosine + end_half_cosine), s = 0.5 * (half_sine + end_half_sine);
    const Pair along_y = 0.5 * (start_y + end_y), along_z = 0.5 * (start_z + end_z);

    // What the axes add to the gradients.
    const PairFrame a = neighbours(frames_before.middle, before + k), b = neighbours(frames_after.middle, after + k);
    const PairVector about_x = cross(b.x, a.x), about_y = cross(b.x, a.y), about_z = cross(b.x, a.z);
    const PairVector of_sine = cross(b.y, a.z) - cross(b.z, a.y), of_cosine = cross(b.y, a.y) + cross(b.z, a.z);

    // Gradients of the three angles
    const PairVector twist_gradient = (change.quotient * cosine) * of_sine - (change.quotient * sine) * of_cosine;
    const Pair half_chi = 0.5 * mean_chi * tangent_quotient;
    const PairVector y_gradient = (mean_chi * s) * about_y - (mean_chi * c) * about_z - (chi_slope * along_y) * about_x +
                                  (half_chi * (z * c - y * s)) * twist_gradient;
    const PairVector z_gradient = (mean_chi * c) * about_y + (mean_chi * s) * about_z - (chi_slope * along_z) * about_x -
                                  (half_chi * (y * c + z * s)) * twist_gradient;

    // The part of bending that is alike about y and z depends on the whole angle alone.
    const Pair y_stiffness = neighbours(y_stiffness_, i), z_stiffness = neighbours(z_stiffness_, i);
    const Pair isotropic{std::min(y_stiffness[0], z_stiffness[0]), std::min(y_stiffness[1], z_stiffness[1])};
    const Pair damping = neighbours(bend_damping_, i);
    const Resistance<Pair> of_y{y_stiffness, damping}, of_z{z_stiffness, damping};
    const Resistance<Pair> of_twist{neighbours(twist_stiffness_, i), neighbours(twist_damping_, i)};
    const Resistance<Pair> beyond_y{y_stiffness - isotropic, damping}, beyond_z{z_stiffness - isotropic, damping};
    const Pair twist_moment = of_twist.stress(start_twist + part * change.angle - neighbours(rest_twist_, i), change.angle);
    Pair y_moment =
        beyond_y.stress(0.5 * (start_chi * start_y + end_chi * end_y), angle_change_y) - y_stiffness * neighbours(rest_y_, i);
    Pair z_moment =
        beyond_z.stress(0.5 * (start_chi * start_z + end_chi * end_z), angle_change_z) - z_stiffness * neighbours(rest_z_, i);
    if constexpr (slides) {
      y_moment += slid_y;
      z_moment += slid_z;
    }
    put(of_y.loss(angle_change_y) + of_z.loss(angle_change_z), bending_loss, i);
    put(of_twist.loss(change.angle), twisting_loss, i);
    put(twist_moment * twist_gradient + (y_moment * y_gradient + z_moment * z_gradient) -
            (isotropic * mean_slope(start.u, end.u)) * about_x,
        moment, i);

    PairSymmetric stiff{};
    stiff = plus_outer(stiff, of_twist.slope(part), twist_gradient);
    stiff = plus_outer(stiff, of_y.slope(part), y_gradient);
    stiff = plus_outer(stiff, of_z.slope(part), z_gradient);
    const auto add_slid = [&](PairSymmetric& sum) {
      sum = plus_outer(sum, slid_yy, y_gradient);
      sum = plus_outer(sum, slid_zz, z_gradient);
      sum = plus_both(sum, (2.0 * slid_yz) * y_gradient, z_gradient);
    };
    if constexpr (slides) add_slid(stiff);
    put(stiff, convex_stiffness, i);
    if (part != 1) continue;

    // The curvatures of the three angles: those of the axes that turn, of twist and of the whole bend.
    const Pair along = y_moment * along_y + z_moment * along_z, across = y_moment * along_z - z_moment * along_y;
    const PairVector y_axis = s * a.y - c * a.z, z_axis = c * a.y + s * a.z;
    const PairVector bent = cross(b.x, y_moment * y_axis + z_moment * z_axis);
    const PairVector turned = cross(b.x, y_moment * z_axis - z_moment * y_axis);
    const Pair whole = isotropic * mean_slope(end.u, end.u) + chi_slope * along;
    const Pair of_twist_and_bend = (twist_moment + 0.5 * end_chi * across) / (2.0 - end.u) + chi_slope * across;
    PairSymmetric exact{};
    exact = plus_outer(exact, of_twist.slope(1) - 0.25 * end_chi * along, twist_gradient);
    exact = plus_outer(exact, beyond_y.slope(1), y_gradient);
    exact = plus_outer(exact, beyond_z.slope(1), z_gradient);
    if constexpr (slides) add_slid(exact);
    exact =
        plus_outer(exact, isotropic * angle_energy_curvature(end.u) + chi_curvature(end.u, end_chi, chi_slope) * along, about_x);
    exact = plus_both(exact, -2.0 * chi_slope * bent - of_twist_and_bend * twist_gradient, about_x);
    exact = plus_both(exact, end_chi * turned, twist_gradient);
    exact = plus_both(exact, end_chi * (y_moment * y_axis + z_moment * z_axis) - whole * a.x, b.x);
    put(plus_diagonal(exact, (1.0 - end.u) * whole - end_chi * along), exact_stiffness, i);
  }
}

}  // namespace verlet_cable

#pragma once

#include <type_traits>

#include "lanes/records.h"
#include "law/bend.h"
#include "law/resistance.h"
#include "law/stretch.h"
#include "rod/node_elimination.h"

namespace verlet_cable {
// Without linkage: what is compiled for one processor is not to be used for another.
namespace {

/// What a matrix that is kept, and the way back, need of an elimination.
template <class Real>
struct KeptPlain {
  SymmetricOf<Real> node;
  VectorOf<Real> cross, node_along, direction, forward_node;
  Real multiplier, multiplier_along, forward_multiplier, first;
};
template <class Real>
struct KeptBending : KeptPlain<Real> {
  Real second;
  MatrixOf<Real> node_next;
  VectorOf<Real> multiplier_next;
};
template <bool bends, class Real>
using Kept = std::conditional_t<bends, KeptBending<Real>, KeptPlain<Real>>;

/// Of an elimination to what is kept, or back.
template <bool bends, class From, class To>
[[gnu::always_inline]] inline void copy_elimination(const From& from, To& to) {
  to.node = from.node;
  to.cross = from.cross;
  to.node_along = from.node_along;
  to.direction = from.direction;
  to.multiplier = from.multiplier;
  to.multiplier_along = from.multiplier_along;
  to.first = from.first;
  if constexpr (bends) {
    to.second = from.second;
    to.node_next = from.node_next;
    to.multiplier_next = from.multiplier_next;
  }
}

/// Of a node at which a cable bends.
template <class Real>
struct Joint {
  VectorOf<Real> moment;          ///< on the change of direction [N m]
  BendStiffness<Real> stiffness;  ///< [N/m]
};

/// `start`: e, `change`: of it over the substep; `at`: the node's place; 1 / length of the segments before and after it; `share`:
/// see BendDamping.
template <Bends bends, class Real>
[[gnu::always_inline]] inline Joint<Real> joint_at(const Place<Real>& at, const VectorOf<Real>& start,
                                                   const VectorOf<Real>& change, const Real& before, const Real& after,
                                                   const Real& share) {
  const Bend<Real> joint = bend(at[LaneField::joint_stiffness], start, dot(start, start), change, 0.5);
  if constexpr (bends == Bends::damped) {
    const Real damping = at[LaneField::joint_damping];
    const BendDamping<Real> damper{damping, at.vector(LaneField::driven_x), at.vector(LaneField::turned_x)};
    return {joint.moment + damper.moment(change, share), bend_stiffness(0.5 * joint.slope + damping, before, after)};
  }
  return {joint.moment, bend_stiffness(0.5 * joint.slope, before, after)};
}

/// A joint seen from the other lane.
template <class Real>
[[gnu::always_inline]] inline Joint<Real> crossed_over(const Joint<Real>& joint) {
  const BendStiffness<Real>& s = joint.stiffness;
  return {crossed_over(joint.moment),
          {crossed_over(s.after), crossed_over(s.own), crossed_over(s.before), crossed_over(s.first_after),
           crossed_over(s.first_before), crossed_over(s.second)}};
}

/// A segment in the middle of the substep, and how its length follows its tension.
template <class Real>
struct Span {
  VectorOf<Real> middle;  ///< d in the substep [m]
  LengthRow<Real> row;
};

template <bool is_elastic, class Real>
[[gnu::always_inline]] inline Span<Real> stretch(const Place<Real>& at, const VectorOf<Real>& change) {
  const Real half = Real{} + 0.5;
  const VectorOf<Real> start = at.vector(LaneField::segment_x), end = start + change;
  const Real density = at[LaneField::density], square = dot(end, end), adjustable = at[LaneField::adjustable];
  Span<Real> span;
  span.middle = start + half * change;
  if constexpr (is_elastic) {
    const Resistance<Real> resistance{at[LaneField::axial_stiffness], at[LaneField::axial_damping]};
    const Real length = root(square), growth = length - at[LaneField::start_length];
    const Real mean = at[LaneField::start_length] + 0.5 * growth;
    span.row = elastic_row(resistance.stress(mean - at[LaneField::target_length], growth), resistance.slope(0.5), density, mean,
                           length, 0.5);
  } else {
    span.row = inextensible_row(square, at[LaneField::target_length], at[LaneField::compliance], density);
  }
  span.row = {adjustable * span.row.gap, adjustable * span.row.compliance + (1.0 - adjustable)};
  return span;
}

template <Bends bending, bool is_elastic, bool is_light, class Real>
void sweep_lanes(const LaneWork& w) {
  constexpr bool bends = bending != Bends::not_at_all;
  constexpr Couplings couplings = bends ? Couplings::bending : Couplings::plain;
  static_assert(sizeof(Kept<bends, Real>) == (bends ? 35 : 22) * sizeof(Real));
  const int m = w.lane;
  auto* kept = reinterpret_cast<Kept<bends, Real>*>(w.eliminations);
  const Real zero{};
  const VectorOf<Real> none{zero, zero, zero};
  // The node that is next to the middle in this lane's way is the other lane's.
  const VectorOf<Real> beyond_middle = crossed_over(place_of<Real>(w, m).vector(LaneField::displacement_x));
  const auto displacement = [&](int k) {
    return k <= m ? place_of<Real>(w, k).vector(LaneField::displacement_x) : beyond_middle;
  };

  const Real active = values_of<Real>(w.values->active), share = values_of<Real>(w.values->share);
  Front<Real> front;
  start(zero, front);
  FrontLoad<Real> load{none, none, zero};
  Real tension_before = zero, clamp_before = zero;  // stiffnesses of the segment before
  VectorOf<Real> force_before = none;               // that segment's on its first node
  const BendStiffness<Real> unresisted{zero, zero, zero, zero, zero, zero};
  Joint<Real> joint{none, unresisted}, joint_next{none, unresisted};
  Real stiffness_before = zero;  // of the joint before, on this node
  VectorOf<Real> u = place_of<Real>(w, 0).vector(LaneField::displacement_x), next = displacement(1),
                 change = without_pad(w, 0, next - u);
  Span<Real> span;
  VectorOf<Real> force;
  Real own, first, second = zero;
  // All that is known at a place of its node and the segment to the next one.
  const auto evaluate = [&](int k) __attribute__((always_inline)) {
    const Place<Real> at = place_of<Real>(w, k);
    span = stretch<is_elastic>(at, change);
    const Real density = at[LaneField::density], tension = 0.5 * density;
    force = density * span.middle;
    own = at[LaneField::inertia] + tension_before + tension;
    first = -tension;
    tension_before = tension;
    if constexpr (bends) {
      const Real inverse = at[LaneField::inverse_length], clamp = at[LaneField::clamp_stiffness];
      VectorOf<Real> after = none;
      if (k < m) {
        const Place<Real> following = place_of<Real>(w, k + 1);
        const Real inverse_after = following[LaneField::inverse_length];
        after = displacement(k + 2) - next;
        joint_next = joint_at<bending>(
            following, inverse_after * following.vector(LaneField::segment_x) - inverse * at.vector(LaneField::segment_x),
            inverse_after * after - inverse * change, inverse, inverse_after, share);
      } else {
        joint_next = crossed_over(joint);
      }
      const VectorOf<Real> other = at.vector(LaneField::clamp_force_x) + inverse * (joint.moment - joint_next.moment);
      at[LaneField::force_along] =
          where(active, dot(other, span.middle) / at[LaneField::target_length], at[LaneField::force_along]);
      force = force + other;
      own = own + clamp_before + clamp + stiffness_before + joint.stiffness.own + joint_next.stiffness.before;
      first = first - clamp + joint.stiffness.first_after + joint_next.stiffness.first_before;
      second = joint_next.stiffness.second;
      clamp_before = clamp;
      stiffness_before = joint.stiffness.after;
      joint = joint_next;
      u = next;
      next = next + after;
      change = after;
    } else if (k < m) {
      u = next;
      next = displacement(k + 2);
      change = next - u;
    }
  };

  for (int k = 0; k < m; ++k) {
    const Place<Real> at = place_of<Real>(w, k);
    const VectorOf<Real> unmoved = at.vector(LaneField::load_x) - at[LaneField::inertia] * u;
    evaluate(k);
    const VectorOf<Real> unbalanced = unmoved + (force - force_before);
    force_before = force;
    Elimination<Real> e;
    if constexpr (is_light) {
      copy_elimination<bends>(kept[k], e);
    } else {
      eliminate<couplings>(plus_diagonal(SymmetricOf<Real>{zero, zero, zero, zero, zero, zero}, own), at[LaneField::movable],
                           NodeCouplings<Real>{span.middle, span.row.compliance, first, {}, second}, front, e);
      copy_elimination<bends>(e, kept[k]);
    }
    Forward<Real> f;
    forward<couplings>(e, unbalanced, span.row.gap, load, f);
    kept[k].forward_node = f.node;
    kept[k].forward_multiplier = f.multiplier;
  }

  const Place<Real> middle = place_of<Real>(w, m);
  const VectorOf<Real> unmoved = middle.vector(LaneField::load_x) - middle[LaneField::inertia] * u;
  evaluate(m);
  const VectorOf<Real> unbalanced = unmoved + (force - force_before);
  const Real movable = middle[LaneField::movable];
  Solved<Real> solved{none, none, zero};
  Real between = zero;
  for (int lane = 0; lane < lanes_of<Real>; lane += 2) {
    const SymmetricOf<double> nothing{0, 0, 0, 0, 0, 0};
    MiddleElimination& elimination = w.middles[lane / 2];
    if constexpr (!is_light)
      eliminate_middle(lane_of(front, lane), lane_of(front, lane + 1), plus_diagonal(nothing, own[lane]),
                       plus_diagonal(nothing, own[lane + 1]), movable[lane], movable[lane + 1],
                       NodeCouplings<double>{lane_of(span.middle, lane), span.row.compliance[lane], first[lane], {}, 0},
                       elimination);
    const MiddleSolution solution =
        solve_middle(elimination, lane_of(unbalanced, lane) + lane_of(load.next, lane) + lane_of(load.after, lane + 1),
                     lane_of(unbalanced, lane + 1) + lane_of(load.next, lane + 1) + lane_of(load.after, lane), load.gap[lane],
                     span.row.gap[lane], load.gap[lane + 1]);
    solved.next.x[lane] = solved.after.x[lane + 1] = solution.left.x;
    solved.next.y[lane] = solved.after.y[lane + 1] = solution.left.y;
    solved.next.z[lane] = solved.after.z[lane + 1] = solution.left.z;
    solved.next.x[lane + 1] = solved.after.x[lane] = solution.right.x;
    solved.next.y[lane + 1] = solved.after.y[lane] = solution.right.y;
    solved.next.z[lane + 1] = solved.after.z[lane] = solution.right.z;
    solved.multiplier[lane] = solution.before;
    solved.multiplier[lane + 1] = solution.after;
    between[lane] = between[lane + 1] = solution.between;
  }

  const auto correct = [&active](const Place<Real>& at, const VectorOf<Real>& u, const Real& multiplier)
      __attribute__((always_inline)) {
    const VectorOf<Real> displacement = at.vector(LaneField::displacement_x);
    const Real density = at[LaneField::density];
    at.set(LaneField::displacement_x, where(active, displacement + u, displacement));
    at[LaneField::density] = where(active, density + multiplier, density);
  };
  correct(middle, solved.next, between);
  Real largest = dot(solved.next, solved.next), sum = largest;
  for (int k = m - 1; k >= 0; --k) {
    const Place<Real> at = place_of<Real>(w, k);
    const Real multiplier = solved.multiplier;
    Elimination<Real> e;
    copy_elimination<bends>(kept[k], e);
    back<couplings>(e, Forward<Real>{kept[k].forward_node, kept[k].forward_multiplier}, solved);
    correct(at, solved.next, multiplier);
    const Real square = dot(solved.next, solved.next);
    largest = greater_of(largest, square);
    sum += square;
  }
  // A NaN may be lost among squares, but not in their sum.
  set_values(largest + 0.0 * sum, w.values->largest);
}

}  // namespace
}  // namespace verlet_cable

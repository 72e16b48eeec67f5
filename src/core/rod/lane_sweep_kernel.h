#pragma once

#include "rod/angle_energy.h"
#include "rod/lane_sweep.h"
#include "rod/node_elimination.h"

namespace verlet_cable {
// Without linkage: what is compiled for one processor is not to be used for another.
namespace {

/// What goes back needs of an elimination.
template <class Real>
struct Kept {
  SymmetricOf<Real> node;
  VectorOf<Real> cross, node_along, forward_node;
  Real multiplier_along, forward_multiplier, first;
  // Where it bends
  Real second;
  MatrixOf<Real> node_next;
  VectorOf<Real> multiplier_next;
};

template <bool bends, class Real>
[[gnu::always_inline]] inline void keep(const Elimination<Real>& e, const Forward<Real>& f, Kept<Real>& kept) {
  kept.node = e.node;
  kept.cross = e.cross;
  kept.node_along = e.node_along;
  kept.forward_node = f.node;
  kept.multiplier_along = e.multiplier_along;
  kept.forward_multiplier = f.multiplier;
  kept.first = e.first;
  if constexpr (bends) {
    kept.second = e.second;
    kept.node_next = e.node_next;
    kept.multiplier_next = e.multiplier_next;
  }
}

template <bool bends, class Real>
[[gnu::always_inline]] inline void recall(const Kept<Real>& kept, Elimination<Real>& e, Forward<Real>& f) {
  e.node = kept.node;
  e.cross = kept.cross;
  e.node_along = kept.node_along;
  f.node = kept.forward_node;
  e.multiplier_along = kept.multiplier_along;
  f.multiplier = kept.forward_multiplier;
  e.first = kept.first;
  if constexpr (bends) {
    e.second = kept.second;
    e.node_next = kept.node_next;
    e.multiplier_next = kept.multiplier_next;
  }
}

/// A record of LaneSystem.
template <class Real>
class Place {
 public:
  explicit Place(Real* values) : values_(values) {}
  Real& operator[](LaneField field) const { return values_[static_cast<int>(field)]; }
  VectorOf<Real> segment() const { return three(LaneField::segment_x); }
  VectorOf<Real> displacement() const { return three(LaneField::displacement_x); }
  VectorOf<Real> load() const { return three(LaneField::load_x); }
  VectorOf<Real> force() const { return three(LaneField::force_x); }
  void displace(const VectorOf<Real>& by) const {
    (*this)[LaneField::displacement_x] += by.x;
    (*this)[LaneField::displacement_y] += by.y;
    (*this)[LaneField::displacement_z] += by.z;
  }

 private:
  VectorOf<Real> three(LaneField first) const {
    const Real* v = values_ + static_cast<int>(first);
    return {v[0], v[1], v[2]};
  }
  Real* values_;
};

/// What the other lane of the same cable has.
template <class Real>
[[gnu::always_inline]] inline Real crossed_over(const Real& a) {
  constexpr int lanes = sizeof(Real) / sizeof(double);
  Real b{};
  for (int i = 0; i < lanes; ++i) b[i] = a[i ^ 1];
  return b;
}
template <class Real>
[[gnu::always_inline]] inline VectorOf<Real> crossed_over(const VectorOf<Real>& a) {
  return {crossed_over(a.x), crossed_over(a.y), crossed_over(a.z)};
}

template <class Real>
[[gnu::always_inline]] inline Real root(const Real& a) {
  constexpr int lanes = sizeof(Real) / sizeof(double);
  Real b{};
  for (int i = 0; i < lanes; ++i) b[i] = __builtin_sqrt(a[i]);
  return b;
}

/// Of a node at which a cable bends; see Bending.
template <class Real>
struct Joint {
  VectorOf<Real> moment;  ///< on the change of direction [N m]
  Real stiffness;         ///< its derivative by that [N m]
};

/// `before`, `after`: segments d and their displacements D over the substep, in rest lengths; of the segment before and after.
template <class Real>
[[gnu::always_inline]] inline Joint<Real> bend(const VectorOf<Real>& start, const VectorOf<Real>& change, const Real& stiffness,
                                               const Real& damping, double part) {
  const Real part_of_all = Real{} + part;
  const VectorOf<Real> end = start + change;
  const Real slope = stiffness * mean_slope<Real>(0.5 * dot(start, start), 0.5 * dot(end, end));
  return {slope * (start + part_of_all * change) + damping * change, part * slope + damping};
}

/// A segment in the middle of the substep, and how its length follows its tension.
template <class Real>
struct Span {
  VectorOf<Real> middle;  ///< d in the substep [m]
  Real gap, compliance;   ///< as of KktSystem
};

template <bool is_elastic, class Real>
[[gnu::always_inline]] inline Span<Real> stretch(const Place<Real>& at, const VectorOf<Real>& change, double part) {
  const VectorOf<Real> start = at.segment(), end = start + change;
  const Real density = at[LaneField::density], square = dot(end, end), adjustable = at[LaneField::adjustable];
  Span<Real> span;
  span.middle = start + (Real{} + part) * change;
  if constexpr (is_elastic) {
    const Real stiffness = at[LaneField::axial_stiffness], damping = at[LaneField::axial_damping];
    const Real length = root(square), growth = length - at[LaneField::start_length];
    const Real mean = at[LaneField::start_length] + part * growth;
    const Real excess = stiffness * (mean - at[LaneField::target_length]) + damping * growth - density * mean;
    const Real by_slope = length / (part * (stiffness - density) + damping);
    span.gap = -adjustable * (excess * by_slope);
    span.compliance = adjustable * (mean * by_slope) + (1.0 - adjustable);
  } else {
    const Real length = at[LaneField::target_length], compliance = at[LaneField::compliance];
    span.gap = adjustable * (0.5 * (length * length - square) + compliance * density);
    span.compliance = compliance + (1.0 - adjustable);
  }
  return span;
}

template <bool bends, bool is_elastic, class Real>
void sweep_lanes(const LaneSweep& s) {
  constexpr Couplings couplings = bends ? Couplings::bending : Couplings::plain;
  constexpr int lanes = sizeof(Real) / sizeof(double);
  static_assert(sizeof(Kept<Real>) <= elimination_size * sizeof(Real));
  const int m = s.lane;
  const double part = s.law.part;
  Kept<Real>* kept = reinterpret_cast<Kept<Real>*>(s.eliminations);
  const auto place = [&](int k) {
    return Place<Real>(reinterpret_cast<Real*>(s.records) + k * static_cast<int>(LaneField::count));
  };
  const Real zero{};
  const VectorOf<Real> none{zero, zero, zero};
  // The node that is next to the middle in this lane's way is the other lane's.
  const VectorOf<Real> beyond_middle = crossed_over(place(m).displacement());
  const auto displacement = [&](int k) { return k <= m ? place(k).displacement() : beyond_middle; };

  Front<Real> front;
  start(zero, front);
  FrontLoad<Real> load{none, none, zero};
  Real tension_before = zero;          // its stiffness, of the segment before
  VectorOf<Real> force_before = none;  // that segment's on its first node
  Real inverse_before = zero;          // its 1 / length
  Joint<Real> joint{none, zero}, joint_next{none, zero};
  Real stiffness_before = zero;  // of the joint before
  VectorOf<Real> u = place(0).displacement(), next = displacement(1), change = next - u;
  Span<Real> span;
  VectorOf<Real> force;
  Real own, first, second = zero, movable;
  // All that is known at a place of its node and the segment to the next one.
  const auto evaluate = [&](int k) {
    const Place<Real> at = place(k);
    span = stretch<is_elastic>(at, change, part);
    const Real density = at[LaneField::density], tension = part * density;
    const VectorOf<Real> pull = density * span.middle;
    VectorOf<Real> other = at.force();
    own = at[LaneField::inertia] + at[LaneField::stiffness] + tension_before + tension;
    first = at[LaneField::coupling] - tension;
    if constexpr (bends) {
      const Real inverse = at[LaneField::inverse_length];
      VectorOf<Real> after = none;
      Real inverse_after;
      if (k < m) {
        const Place<Real> following = place(k + 1);
        inverse_after = following[LaneField::inverse_length];
        after = displacement(k + 2) - next;
        joint_next = bend(inverse_after * following.segment() - inverse * at.segment(), inverse_after * after - inverse * change,
                          following[LaneField::joint_stiffness], following[LaneField::joint_damping], part);
      } else {
        inverse_after = crossed_over(inverse_before);
        joint_next = {crossed_over(joint.moment), crossed_over(joint.stiffness)};
      }
      other = other + inverse * (joint.moment - joint_next.moment);
      const Real bent = inverse_before + inverse, bent_next = inverse + inverse_after;
      own = own + stiffness_before * inverse_before * inverse_before + joint.stiffness * bent * bent +
            joint_next.stiffness * inverse * inverse;
      first = first - joint.stiffness * inverse * bent - joint_next.stiffness * inverse * bent_next;
      second = joint_next.stiffness * inverse * inverse_after;
      stiffness_before = joint.stiffness;
      joint = joint_next;
      inverse_before = inverse;
      u = next;
      next = next + after;
      change = after;
    } else if (k < m) {
      u = next;
      next = displacement(k + 2);
      change = next - u;
    }
    at[LaneField::force_along] = dot(other, span.middle) / at[LaneField::target_length];
    force = pull + other;
    tension_before = tension;
    movable = at[LaneField::movable];
  };

  for (int k = 0; k < m; ++k) {
    const Place<Real> at = place(k);
    const VectorOf<Real> node_displacement = u;
    evaluate(k);
    const VectorOf<Real> unbalanced = at.load() - at[LaneField::inertia] * node_displacement + (force - force_before);
    force_before = force;
    Elimination<Real> e;
    Forward<Real> f;
    eliminate<couplings>(plus_diagonal(SymmetricOf<Real>{zero, zero, zero, zero, zero, zero}, own), movable,
                         NodeCouplings<Real>{span.middle, span.compliance, first, {}, second}, front, e);
    forward<couplings>(e, unbalanced, span.gap, load, f);
    keep<bends>(e, f, kept[k]);
  }

  const Place<Real> middle = place(m);
  const VectorOf<Real> node_displacement = u;
  evaluate(m);
  const VectorOf<Real> unbalanced = middle.load() - middle[LaneField::inertia] * node_displacement + (force - force_before);
  Solved<Real> solved{none, none, zero};
  Real between = zero;
  for (int lane = 0; lane < lanes; lane += 2) {
    const SymmetricOf<double> nothing{0, 0, 0, 0, 0, 0};
    MiddleElimination elimination;
    eliminate_middle(lane_of(front, lane), lane_of(front, lane + 1), plus_diagonal(nothing, own[lane]),
                     plus_diagonal(nothing, own[lane + 1]), movable[lane], movable[lane + 1],
                     NodeCouplings<double>{lane_of(span.middle, lane), span.compliance[lane], first[lane], nothing, 0},
                     elimination);
    const MiddleSolution solution =
        solve_middle(elimination, lane_of(unbalanced, lane) + lane_of(load.next, lane) + lane_of(load.after, lane + 1),
                     lane_of(unbalanced, lane + 1) + lane_of(load.next, lane + 1) + lane_of(load.after, lane), load.gap[lane],
                     span.gap[lane], load.gap[lane + 1]);
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

  const Real active = *reinterpret_cast<const Real*>(s.active);
  middle.displace(active * solved.next);
  middle[LaneField::density] += active * between;
  Real largest = dot(solved.next, solved.next);
  for (int k = m - 1; k >= 0; --k) {
    const Place<Real> at = place(k);
    at[LaneField::density] += active * solved.multiplier;
    Elimination<Real> e;
    Forward<Real> f;
    recall<bends>(kept[k], e, f);
    back<couplings>(e, f, solved);
    at.displace(active * solved.next);
    const Real square = dot(solved.next, solved.next);
    largest = square <= largest ? largest : square;  // keeps a NaN
  }
  *reinterpret_cast<Real*>(s.squares) = largest;
}

template <class Real>
void sweep_lanes(const LaneSweep& s) {
  if (s.law.bends && s.law.is_elastic)
    sweep_lanes<true, true, Real>(s);
  else if (s.law.bends)
    sweep_lanes<true, false, Real>(s);
  else if (s.law.is_elastic)
    sweep_lanes<false, true, Real>(s);
  else
    sweep_lanes<false, false, Real>(s);
}

}  // namespace
}  // namespace verlet_cable

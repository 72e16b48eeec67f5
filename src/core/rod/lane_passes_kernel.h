#pragma once

#include <type_traits>

#include "rod/angle_energy.h"
#include "rod/lane_passes.h"
#include "rod/node_elimination.h"

namespace verlet_cable {
// Without linkage: what is compiled for one processor is not to be used for another.
namespace {

template <class Real>
constexpr int lanes_of = sizeof(Real) / sizeof(double);

/// How cables bend.
enum class Bends { not_at_all, freely, damped };

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

template <bool bends, class Real>
[[gnu::always_inline]] inline void keep(const Elimination<Real>& e, Kept<bends, Real>& kept) {
  kept.node = e.node;
  kept.cross = e.cross;
  kept.node_along = e.node_along;
  kept.direction = e.direction;
  kept.multiplier = e.multiplier;
  kept.multiplier_along = e.multiplier_along;
  kept.first = e.first;
  if constexpr (bends) {
    kept.second = e.second;
    kept.node_next = e.node_next;
    kept.multiplier_next = e.multiplier_next;
  }
}

template <bool bends, class Real>
[[gnu::always_inline]] inline void recall(const Kept<bends, Real>& kept, Elimination<Real>& e) {
  e.node = kept.node;
  e.cross = kept.cross;
  e.node_along = kept.node_along;
  e.direction = kept.direction;
  e.multiplier = kept.multiplier;
  e.multiplier_along = kept.multiplier_along;
  e.first = kept.first;
  if constexpr (bends) {
    e.second = kept.second;
    e.node_next = kept.node_next;
    e.multiplier_next = kept.multiplier_next;
  }
}

/// A record.
template <class Real>
class Place {
 public:
  explicit Place(Real* values) : values_(values) {}
  Real& operator[](LaneField field) const { return values_[static_cast<int>(field)]; }
  VectorOf<Real> vector(LaneField first) const {
    const Real* v = values_ + static_cast<int>(first);
    return {v[0], v[1], v[2]};
  }
  void set(LaneField first, const VectorOf<Real>& v) const {
    Real* to = values_ + static_cast<int>(first);
    to[0] = v.x;
    to[1] = v.y;
    to[2] = v.z;
  }

 private:
  Real* values_;
};

template <class Real>
[[gnu::always_inline]] inline Place<Real> place_of(const LaneWork& w, int k) {
  return Place<Real>(reinterpret_cast<Real*>(w.records) + k * w.record);
}

template <class Real>
[[gnu::always_inline]] inline Real values_of(const double (&values)[most_lanes]) {
  return *reinterpret_cast<const Real*>(values);
}
template <class Real>
[[gnu::always_inline]] inline void set_values(const Real& from, double (&values)[most_lanes]) {
  *reinterpret_cast<Real*>(values) = from;
}

/// What the other lane of the same cable has.
template <class Real>
[[gnu::always_inline]] inline Real crossed_over(const Real& a) {
  Real b{};
  for (int i = 0; i < lanes_of<Real>; ++i) b[i] = a[i ^ 1];
  return b;
}
template <class Real>
[[gnu::always_inline]] inline VectorOf<Real> crossed_over(const VectorOf<Real>& a) {
  return {crossed_over(a.x), crossed_over(a.y), crossed_over(a.z)};
}

template <class Real>
[[gnu::always_inline]] inline Real root(const Real& a) {
  Real b{};
  for (int i = 0; i < lanes_of<Real>; ++i) b[i] = __builtin_sqrt(a[i]);
  return b;
}

/// `changed` where a mark is not 0: elsewhere nothing changes, not even the sign of a zero.
template <class Real>
[[gnu::always_inline]] inline Real where(const Real& mark, const Real& changed, const Real& kept) {
  return mark != 0.0 ? changed : kept;
}
template <class Real>
[[gnu::always_inline]] inline VectorOf<Real> where(const Real& mark, const VectorOf<Real>& changed, const VectorOf<Real>& kept) {
  return {where(mark, changed.x, kept.x), where(mark, changed.y, kept.y), where(mark, changed.z, kept.z)};
}

template <class Real>
[[gnu::always_inline]] inline Real greater_of(const Real& a, const Real& b) {
  return a < b ? b : a;
}
template <class Real>
[[gnu::always_inline]] inline Real lesser_of(const Real& a, const Real& b) {
  return b < a ? b : a;
}

/// A cable's node or segment at a place of a lane. What pads has the numbers of its neighbour, and nothing comes of them.
[[gnu::always_inline]] inline int node_at(const LaneWork& w, int k, int lane) {
  return lane % 2 == 0 ? k : w.last_node - (w.padded && k == 0 ? 1 : k);
}
[[gnu::always_inline]] inline int segment_at(const LaneWork& w, int k, int lane) {
  return lane % 2 == 0 ? k : w.last_node - 1 - (w.padded && k == 0 ? 1 : k);
}

/// Nothing, where a lane starts with what pads it.
template <class Real>
[[gnu::always_inline]] inline VectorOf<Real> without_pad(const LaneWork& w, int k, VectorOf<Real> v) {
  if (w.padded && k == 0)
    for (int i = 1; i < lanes_of<Real>; i += 2) v.x[i] = v.y[i] = v.z[i] = 0;
  return v;
}

template <class Real>
[[gnu::always_inline]] inline VectorOf<Real> gather_vector(const LaneWork& w, double* LaneCable::*array, int k) {
  VectorOf<Real> v;
  for (int i = 0; i < lanes_of<Real>; ++i) {
    const double* from = w.cables[i / 2].*array + 3 * node_at(w, k, i);
    v.x[i] = from[0];
    v.y[i] = from[1];
    v.z[i] = from[2];
  }
  return v;
}
template <class Real>
[[gnu::always_inline]] inline Real gather_node(const LaneWork& w, const double* LaneCable::*array, int k) {
  Real v;
  for (int i = 0; i < lanes_of<Real>; ++i) v[i] = (w.cables[i / 2].*array)[node_at(w, k, i)];
  return v;
}
template <class Real, class Numbers>
[[gnu::always_inline]] inline Real gather_segment(const LaneWork& w, Numbers* LaneCable::*array, int k) {
  Real v;
  for (int i = 0; i < lanes_of<Real>; ++i) v[i] = (w.cables[i / 2].*array)[segment_at(w, k, i)];
  return v;
}

template <Bends bends, bool is_elastic, class Real>
void load_lanes(const LaneWork& w) {
  const LaneValues& values = *w.values;
  const double h = w.law.h;
  const Real zero{}, one = zero + 1.0, duration = zero + h, half_duration = zero + 0.5 * h;
  const VectorOf<Real> none{zero, zero, zero};
  const VectorOf<Real> gravity{values_of<Real>(values.gravity_x), values_of<Real>(values.gravity_y),
                               values_of<Real>(values.gravity_z)};
  const VectorOf<Real> wind{values_of<Real>(values.wind_x), values_of<Real>(values.wind_y), values_of<Real>(values.wind_z)};
  const Real drag = values_of<Real>(values.drag);
  VectorOf<Real> here = gather_vector<Real>(w, &LaneCable::positions, 0);
  Real half_before = zero, length_before = zero;
  for (int k = 0; k <= w.lane; ++k) {
    const Place<Real> at = place_of<Real>(w, k);
    const VectorOf<Real> next = gather_vector<Real>(w, &LaneCable::positions, k + 1);
    const VectorOf<Real> segment = next - here;
    here = next;
    const Real rest = gather_segment<Real>(w, &LaneCable::rest_lengths, k);
    const Real mass = gather_node<Real>(w, &LaneCable::masses, k);
    const VectorOf<Real> velocity = gather_vector<Real>(w, &LaneCable::velocities, k);
    const VectorOf<Real> acceleration = gather_vector<Real>(w, &LaneCable::accelerations, k);
    Real half = 0.5 * rest;
    if (w.padded && k == 0)
      for (int i = 1; i < lanes_of<Real>; i += 2) half[i] = 0;
    const Real length = half_before + half, inertia = 2.0 * mass / h;
    half_before = half;
    at.set(LaneField::segment_x, segment);
    at.set(LaneField::displacement_x, duration * (velocity + half_duration * acceleration));
    at.set(LaneField::load_x, mass * gravity + inertia * velocity + length * wind);
    at[LaneField::inertia] = inertia / h + drag * length;
    at[LaneField::movable] = at[LaneField::adjustable] = one;
    at[LaneField::target_length] = gather_segment<Real>(w, &LaneCable::target_lengths, k);
    at[LaneField::inverse_length] = 1.0 / rest;
    at[LaneField::inverse_mass] = 1.0 / mass;
    at.set(LaneField::velocity_x, velocity);
    at.set(LaneField::start_acceleration_x, acceleration);
    const Real multiplier = gather_segment<Real>(w, &LaneCable::axial_multiplier, k);
    if constexpr (is_elastic) {
      const Real start = root(dot(segment, segment));
      at[LaneField::start_length] = start;
      at[LaneField::axial_stiffness] = values_of<Real>(values.axial_stiffness) / rest;
      at[LaneField::axial_damping] = values_of<Real>(values.axial_damping) / rest;
      at[LaneField::density] = multiplier / start;
    } else {
      at[LaneField::compliance] = zero;
      at[LaneField::density] = multiplier / rest;
    }
    if constexpr (bends != Bends::not_at_all) {
      at[LaneField::joint_stiffness] = values_of<Real>(values.bending_stiffness) * (1.0 / (0.5 * (length_before + rest)));
      at.set(LaneField::clamp_force_x, none);
      at[LaneField::clamp_stiffness] = zero;
      length_before = rest;
    }
  }
}

/// Of a node at which a cable bends; see Bending.
template <class Real>
struct Joint {
  VectorOf<Real> moment;  ///< on the change of direction [N m]
  Real stiffness;         ///< its derivative by that [N m]
};

/// `start`: e, `change`: of it over the substep; `at`: the node's place.
template <Bends bends, class Real>
[[gnu::always_inline]] inline Joint<Real> bend(const VectorOf<Real>& start, const VectorOf<Real>& change, const Place<Real>& at) {
  const Real half = Real{} + 0.5;
  const VectorOf<Real> end = start + change;
  const Real slope = at[LaneField::joint_stiffness] * mean_slope<Real>(0.5 * dot(start, start), 0.5 * dot(end, end));
  Joint<Real> joint{slope * (start + half * change), 0.5 * slope};
  if constexpr (bends == Bends::damped) {
    const Real damping = at[LaneField::joint_damping];
    joint.moment = joint.moment + damping * (change - at.vector(LaneField::turned_x));
    joint.stiffness = joint.stiffness + damping;
  }
  return joint;
}

/// A segment in the middle of the substep, and how its length follows its tension.
template <class Real>
struct Span {
  VectorOf<Real> middle;  ///< d in the substep [m]
  Real gap, compliance;   ///< as of KktSystem
};

template <bool is_elastic, class Real>
[[gnu::always_inline]] inline Span<Real> stretch(const Place<Real>& at, const VectorOf<Real>& change) {
  const Real half = Real{} + 0.5;
  const VectorOf<Real> start = at.vector(LaneField::segment_x), end = start + change;
  const Real density = at[LaneField::density], square = dot(end, end), adjustable = at[LaneField::adjustable];
  Span<Real> span;
  span.middle = start + half * change;
  if constexpr (is_elastic) {
    const Real stiffness = at[LaneField::axial_stiffness], damping = at[LaneField::axial_damping];
    const Real length = root(square), growth = length - at[LaneField::start_length];
    const Real mean = at[LaneField::start_length] + 0.5 * growth;
    const Real excess = stiffness * (mean - at[LaneField::target_length]) + damping * growth - density * mean;
    const Real by_slope = length / (0.5 * (stiffness - density) + damping);
    span.gap = -adjustable * (excess * by_slope);
    span.compliance = adjustable * (mean * by_slope) + (1.0 - adjustable);
  } else {
    const Real length = at[LaneField::target_length], compliance = at[LaneField::compliance];
    span.gap = adjustable * (0.5 * (length * length - square) + compliance * density);
    span.compliance = adjustable * compliance + (1.0 - adjustable);
  }
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

  const Real active = values_of<Real>(w.values->active);
  Front<Real> front;
  start(zero, front);
  FrontLoad<Real> load{none, none, zero};
  Real tension_before = zero, clamp_before = zero;  // stiffnesses of the segment before
  VectorOf<Real> force_before = none;               // that segment's on its first node
  Real inverse_before = zero;                       // its 1 / length
  Joint<Real> joint{none, zero}, joint_next{none, zero};
  Real stiffness_before = zero;  // of the joint before
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
      Real inverse_after;
      if (k < m) {
        const Place<Real> following = place_of<Real>(w, k + 1);
        inverse_after = following[LaneField::inverse_length];
        after = displacement(k + 2) - next;
        joint_next =
            bend<bending>(inverse_after * following.vector(LaneField::segment_x) - inverse * at.vector(LaneField::segment_x),
                          inverse_after * after - inverse * change, following);
      } else {
        inverse_after = crossed_over(inverse_before);
        joint_next = {crossed_over(joint.moment), crossed_over(joint.stiffness)};
      }
      const VectorOf<Real> other = at.vector(LaneField::clamp_force_x) + inverse * (joint.moment - joint_next.moment);
      at[LaneField::force_along] =
          where(active, dot(other, span.middle) / at[LaneField::target_length], at[LaneField::force_along]);
      force = force + other;
      const Real bent = inverse_before + inverse, bent_next = inverse + inverse_after;
      own = own + clamp_before + clamp + stiffness_before * inverse_before * inverse_before + joint.stiffness * bent * bent +
            joint_next.stiffness * inverse * inverse;
      first = first - clamp - joint.stiffness * inverse * bent - joint_next.stiffness * inverse * bent_next;
      second = joint_next.stiffness * inverse * inverse_after;
      clamp_before = clamp;
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
  };

  for (int k = 0; k < m; ++k) {
    const Place<Real> at = place_of<Real>(w, k);
    const VectorOf<Real> unmoved = at.vector(LaneField::load_x) - at[LaneField::inertia] * u;
    evaluate(k);
    const VectorOf<Real> unbalanced = unmoved + (force - force_before);
    force_before = force;
    Elimination<Real> e;
    if constexpr (is_light) {
      recall<bends, Real>(kept[k], e);
    } else {
      eliminate<couplings>(plus_diagonal(SymmetricOf<Real>{zero, zero, zero, zero, zero, zero}, own), at[LaneField::movable],
                           NodeCouplings<Real>{span.middle, span.compliance, first, {}, second}, front, e);
      keep<bends, Real>(e, kept[k]);
    }
    Forward<Real> f;
    forward<couplings>(e, unbalanced, span.gap, load, f);
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
    recall<bends, Real>(kept[k], e);
    back<couplings>(e, Forward<Real>{kept[k].forward_node, kept[k].forward_multiplier}, solved);
    correct(at, solved.next, multiplier);
    const Real square = dot(solved.next, solved.next);
    largest = greater_of(largest, square);
    sum += square;
  }
  // A NaN may be lost among squares, but not in their sum.
  set_values(largest + 0.0 * sum, w.values->largest);
}

/// The velocities' projection: see CableStepper::project. Down to the middle, and back up.
template <class Real>
class Projection {
 public:
  /// The row of the segment of a place, `next` being the place of its other node. `direction`: d' there and after it.
  [[gnu::always_inline]] void eliminate(const Place<Real>& at, const VectorOf<Real>& direction,
                                        const VectorOf<Real>& direction_next, const VectorOf<Real>& velocity_next,
                                        const Real& inverse_mass_next) {
    Real diagonal, load;
    set_row(at, direction, velocity_next, inverse_mass_next, diagonal, load);
    before_ = 1.0 / (diagonal - ratio_ * coupling_);
    value_ = load - ratio_ * value_;
    coupling_ = -inverse_mass_next * dot(direction, direction_next);
    ratio_ = coupling_ * before_;
    at[LaneField::pivot] = before_;
    at[LaneField::off] = coupling_;
    at[LaneField::impulse] = value_;
  }
  /// The segment where the lanes meet: its impulse.
  [[gnu::always_inline]] Real middle(const Place<Real>& at, const VectorOf<Real>& direction, const VectorOf<Real>& velocity_next,
                                     const Real& inverse_mass_next) {
    Real diagonal, load;
    set_row(at, direction, velocity_next, inverse_mass_next, diagonal, load);
    const Real matrix = ratio_ * coupling_, value = ratio_ * value_;
    return (load - (value + crossed_over(value))) / (diagonal - (matrix + crossed_over(matrix)));
  }

 private:
  [[gnu::always_inline]] static void set_row(const Place<Real>& at, const VectorOf<Real>& direction,
                                             const VectorOf<Real>& velocity_next, const Real& inverse_mass_next, Real& diagonal,
                                             Real& load) {
    constexpr double pivot_regularisation = 1e-9;
    const Real adjustable = at[LaneField::adjustable], mobility = at[LaneField::inverse_mass] + inverse_mass_next;
    diagonal = adjustable * (dot(direction, direction) * mobility * (1 + pivot_regularisation)) + (1.0 - adjustable);
    load = adjustable * dot(direction, at.vector(LaneField::end_velocity_x) - velocity_next);
  }
  Real ratio_{}, coupling_{}, before_{}, value_{};
};

template <bool projects, class Real>
void finish_lanes(const LaneWork& w) {
  const int m = w.lane;
  LaneValues& values = *w.values;
  const Real zero{}, one = zero + 1.0, rate = zero + 2 / w.law.h, inverse_h = zero + 1 / w.law.h;
  const VectorOf<Real> none{zero, zero, zero};
  // What a place knows at the end of the substep.
  const auto end_velocity = [&](int k) {
    const Place<Real> at = place_of<Real>(w, k);
    return rate * at.vector(LaneField::displacement_x) - at.vector(LaneField::velocity_x);
  };
  Real longest = one, shortest = one;
  {
    VectorOf<Real> u = place_of<Real>(w, 0).vector(LaneField::displacement_x), direction_before = none;
    Projection<Real> projection;
    const VectorOf<Real> u_beyond = crossed_over(place_of<Real>(w, m).vector(LaneField::displacement_x));
    Real impulse = zero;
    for (int k = 0; k <= m; ++k) {
      const Place<Real> at = place_of<Real>(w, k);
      const VectorOf<Real> velocity = end_velocity(k);
      const VectorOf<Real> u_next = k < m ? place_of<Real>(w, k + 1).vector(LaneField::displacement_x) : u_beyond;
      const VectorOf<Real> direction = without_pad(w, k, at.vector(LaneField::segment_x) + (u_next - u));
      u = u_next;
      at.set(LaneField::segment_x, direction);
      at.set(LaneField::end_velocity_x, velocity);
      const Real inverse = at[LaneField::inverse_length];
      Real relative = dot(direction, direction) * (inverse * inverse);
      if (w.padded && k == 0)
        for (int i = 1; i < lanes_of<Real>; i += 2) relative[i] = 1;
      longest = greater_of(longest, relative);
      shortest = lesser_of(shortest, relative);
      if constexpr (projects) {
        if (k > 0)
          projection.eliminate(place_of<Real>(w, k - 1), direction_before, direction, velocity, at[LaneField::inverse_mass]);
        if (k == m) impulse = projection.middle(at, direction, crossed_over(velocity), crossed_over(at[LaneField::inverse_mass]));
        direction_before = direction;
      }
    }
    place_of<Real>(w, m)[LaneField::impulse] = impulse;
  }
  set_values(longest, values.longest);
  set_values(shortest, values.shortest);

  Real product = zero, square = zero, mass = zero;
  const Real known = values_of<Real>(values.known), wanted = values_of<Real>(values.projects);
  Real impulse = place_of<Real>(w, m)[LaneField::impulse];
  for (int k = m; k >= 0; --k) {
    const Place<Real> at = place_of<Real>(w, k);
    VectorOf<Real> velocity = at.vector(LaneField::end_velocity_x);
    if constexpr (projects) {
      VectorOf<Real> pull = none - impulse * at.vector(LaneField::segment_x);
      if (k > 0) {
        const Place<Real> before = place_of<Real>(w, k - 1);
        impulse = (before[LaneField::impulse] - before[LaneField::off] * impulse) * before[LaneField::pivot];
        before[LaneField::impulse] = impulse;
        pull = pull + impulse * before.vector(LaneField::segment_x);
      }
      velocity = where(wanted, velocity + at[LaneField::inverse_mass] * pull, velocity);
      at.set(LaneField::end_velocity_x, velocity);
    }
    const VectorOf<Real> acceleration = inverse_h * (velocity - at.vector(LaneField::velocity_x));
    at.set(LaneField::acceleration_x, acceleration);
    if (w.law.is_watched) {
      const VectorOf<Real> change = acceleration - at.vector(LaneField::start_acceleration_x);
      const VectorOf<Real> turn = known * (change - gather_vector<Real>(w, &LaneCable::acceleration_changes, k));
      at.set(LaneField::change_x, change);
      at.set(LaneField::turn_x, turn);
      const VectorOf<Real> last = gather_vector<Real>(w, &LaneCable::turns, k);
      const Real weight = at[LaneField::movable] * gather_node<Real>(w, &LaneCable::masses, k);
      product += weight * dot(turn, last);
      square += 0.5 * weight * (dot(turn, turn) + dot(last, last));
      mass += weight;
    }
  }
  set_values(product, values.product);
  set_values(square, values.square);
  set_values(mass, values.mass);
}

/// Where lanes write to: all of them at most places of most batches.
template <bool all, class Real>
class Scatter {
 public:
  [[gnu::always_inline]] Scatter(const LaneWork& w, int k) : work_(w), place_(k) {}
  [[gnu::always_inline]] void nodes(double* LaneCable::*array, const VectorOf<Real>& v) const {
    for (int i = 0; i < lanes_of<Real>; ++i) {
      if (!has_node(i)) continue;
      double* to = work_.cables[i / 2].*array + 3 * node_at(work_, place_, i);
      to[0] = v.x[i];
      to[1] = v.y[i];
      to[2] = v.z[i];
    }
  }
  [[gnu::always_inline]] void add_to_nodes(double* LaneCable::*array, const VectorOf<Real>& v) const {
    for (int i = 0; i < lanes_of<Real>; ++i) {
      if (!has_node(i)) continue;
      double* to = work_.cables[i / 2].*array + 3 * node_at(work_, place_, i);
      to[0] += v.x[i];
      to[1] += v.y[i];
      to[2] += v.z[i];
    }
  }
  [[gnu::always_inline]] void segments(double* LaneCable::*array, const Real& v) const {
    for (int i = 0; i < lanes_of<Real>; ++i)
      if (has_segment(i)) (work_.cables[i / 2].*array)[segment_at(work_, place_, i)] = v[i];
  }

 private:
  [[gnu::always_inline]] bool has_node(int i) const {
    return all || (work_.values->stores[i] != 0 && !(work_.padded && place_ == 0 && i % 2 == 1));
  }
  /// The segment in the middle is the first lane's.
  [[gnu::always_inline]] bool has_segment(int i) const { return all || (has_node(i) && !(i % 2 == 1 && place_ == work_.lane)); }
  const LaneWork& work_;
  int place_;
};

template <Bends bends, bool is_elastic, bool all, class Real>
[[gnu::always_inline]] inline void store_place(const LaneWork& w, int k) {
  const Place<Real> at = place_of<Real>(w, k);
  const Scatter<all, Real> scatter(w, k);
  scatter.add_to_nodes(&LaneCable::positions, at.vector(LaneField::displacement_x));
  scatter.nodes(&LaneCable::velocities, at.vector(LaneField::end_velocity_x));
  scatter.nodes(&LaneCable::accelerations, at.vector(LaneField::acceleration_x));
  if (w.law.is_watched) {
    scatter.nodes(&LaneCable::acceleration_changes, at.vector(LaneField::change_x));
    scatter.nodes(&LaneCable::turns, at.vector(LaneField::turn_x));
  }
  Real length = at[LaneField::target_length];
  if constexpr (is_elastic) {
    const VectorOf<Real> end = at.vector(LaneField::segment_x);
    length = at[LaneField::start_length] + 0.5 * (root(dot(end, end)) - at[LaneField::start_length]);
  }
  const Real multiplier = at[LaneField::density] * length;
  Real tension = multiplier;
  if constexpr (bends != Bends::not_at_all) tension = tension + at[LaneField::force_along];
  const Real last = gather_segment<Real>(w, &LaneCable::last_tension, k);
  scatter.segments(&LaneCable::axial_multiplier, multiplier);
  scatter.segments(&LaneCable::tension, where(values_of<Real>(w.values->smooths), 0.5 * (last + tension), tension));
  scatter.segments(&LaneCable::last_tension, tension);
}

template <Bends bends, bool is_elastic, class Real>
void store_lanes(const LaneWork& w) {
  bool all = true;
  for (int i = 0; i < lanes_of<Real>; ++i) all = all && w.values->stores[i] != 0;
  for (int k = 0; k <= w.lane; ++k) {
    if (all && k > 0 && k < w.lane)
      store_place<bends, is_elastic, true, Real>(w, k);
    else
      store_place<bends, is_elastic, false, Real>(w, k);
  }
}

template <Bends value>
using BendsConstant = std::integral_constant<Bends, value>;

/// Calls what is compiled for the cables' law.
template <class Call>
void by_law(const LaneLaw& law, const Call& call) {
  const auto with = [&](auto bends) {
    if (law.is_elastic)
      call(bends, std::true_type());
    else
      call(bends, std::false_type());
  };
  if (law.is_damped)
    with(BendsConstant<Bends::damped>());
  else if (law.bends)
    with(BendsConstant<Bends::freely>());
  else
    with(BendsConstant<Bends::not_at_all>());
}

template <class Real>
LanePasses passes_of_lanes() {
  LanePasses passes;
  passes.lanes = lanes_of<Real>;
  passes.load = [](const LaneWork& w) {
    by_law(w.law, [&](auto bends, auto elastic) { load_lanes<bends.value, elastic.value, Real>(w); });
  };
  passes.sweep = [](const LaneWork& w) {
    by_law(w.law, [&](auto bends, auto elastic) { sweep_lanes<bends.value, elastic.value, false, Real>(w); });
  };
  passes.light_sweep = [](const LaneWork& w) {
    by_law(w.law, [&](auto bends, auto elastic) { sweep_lanes<bends.value, elastic.value, true, Real>(w); });
  };
  passes.finish = [](const LaneWork& w) {
    bool projects = false;
    for (int i = 0; i < lanes_of<Real>; ++i) projects = projects || w.values->projects[i] != 0;
    if (projects)
      finish_lanes<true, Real>(w);
    else
      finish_lanes<false, Real>(w);
  };
  passes.store = [](const LaneWork& w) {
    by_law(w.law, [&](auto bends, auto elastic) { store_lanes<bends.value, elastic.value, Real>(w); });
  };
  return passes;
}

}  // namespace
}  // namespace verlet_cable

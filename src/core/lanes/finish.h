#pragma once

#include "lanes/records.h"
#include "law/length_rate.h"

namespace verlet_cable {
// Without linkage: what is compiled for one processor is not to be used for another.
namespace {

/// The velocities' projection: see CableStepper::project. Down to the middle.
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
    ended_ = ended_ + value_ * value_ * before_;
    coupling_ = length_rate_coupling(dot(direction, direction_next), inverse_mass_next);
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
    load = load - (value + crossed_over(value));
    const Real impulse = load / (diagonal - (matrix + crossed_over(matrix)));
    ended_ = ended_ + 0.5 * (load * impulse);  // either lane has half of it
    return impulse;
  }
  /// [J] Impulses times the rates that they end, of a lane.
  Real ended() const { return ended_; }

 private:
  [[gnu::always_inline]] static void set_row(const Place<Real>& at, const VectorOf<Real>& direction,
                                             const VectorOf<Real>& velocity_next, const Real& inverse_mass_next, Real& diagonal,
                                             Real& load) {
    const Real adjustable = at[LaneField::adjustable], mobility = at[LaneField::inverse_mass] + inverse_mass_next;
    diagonal = adjustable * length_rate_diagonal(dot(direction, direction), mobility) + (1.0 - adjustable);
    load = adjustable * dot(direction, at.vector(LaneField::end_velocity_x) - velocity_next);
  }
  Real ratio_{}, coupling_{}, before_{}, value_{}, ended_{};
};

template <bool projects, class Real>
void project_lanes(const LaneWork& w) {
  const int m = w.lane;
  LaneValues& values = *w.values;
  const Real zero{}, one = zero + 1.0, rate = zero + 2 / w.law.h;
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
    if constexpr (projects) {
      set_values(projection.ended(), values.ended);
      for (int k = m - 1; k >= 0; --k) {
        const Place<Real> at = place_of<Real>(w, k);
        impulse = (at[LaneField::impulse] - at[LaneField::off] * impulse) * at[LaneField::pivot];
        at[LaneField::impulse] = impulse;
      }
    }
  }
  set_values(longest, values.longest);
  set_values(shortest, values.shortest);
}

template <bool projects, class Real>
void finish_lanes(const LaneWork& w) {
  const int m = w.lane;
  LaneValues& values = *w.values;
  const Real zero{}, inverse_h = zero + 1 / w.law.h;
  const VectorOf<Real> none{zero, zero, zero};
  Real product = zero, square = zero, mass = zero;
  const Real known = values_of<Real>(values.known), wanted = values_of<Real>(values.projects);
  const Real mended = values_of<Real>(values.mended);
  Real impulse = mended * place_of<Real>(w, m)[LaneField::impulse];
  for (int k = m; k >= 0; --k) {
    const Place<Real> at = place_of<Real>(w, k);
    VectorOf<Real> velocity = at.vector(LaneField::end_velocity_x);
    if constexpr (projects) {
      at[LaneField::impulse] = impulse;
      VectorOf<Real> pull = none - impulse * at.vector(LaneField::segment_x);
      if (k > 0) {
        const Place<Real> before = place_of<Real>(w, k - 1);
        impulse = mended * before[LaneField::impulse];
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

}  // namespace
}  // namespace verlet_cable

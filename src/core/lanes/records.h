#pragma once

#include "geometry/lane_algebra.h"
#include "lanes/passes.h"

namespace verlet_cable {
// Without linkage: what is compiled for one processor is not to be used for another.
namespace {

template <class Real>
constexpr int lanes_of = sizeof(Real) / sizeof(double);

/// How cables bend.
enum class Bends { not_at_all, freely, damped };

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

}  // namespace
}  // namespace verlet_cable

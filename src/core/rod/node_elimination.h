#pragma once

#include "geometry/lane_algebra.h"

namespace verlet_cable {

/// Elimination of a cable's KktSystem node by node, from an end towards the middle: with each node goes the multiplier before it,
/// so that no pivot vanishes at a held end. `Real`: see lane_algebra.h.

/// What the eliminated nodes left to the next node, to the one after, and to the multiplier before the next node.
template <class Real>
struct Front {
  SymmetricOf<Real> next;   ///< block of the next node
  MatrixOf<Real> between;   ///< of the next node and the one after
  SymmetricOf<Real> after;  ///< of the one after
  VectorOf<Real> reach;     ///< of the multiplier and the next node
  VectorOf<Real> beyond;    ///< of the multiplier and the one after
  Real compliance;          ///< of the multiplier
};

/// The same of the right-hand sides.
template <class Real>
struct FrontLoad {
  VectorOf<Real> next, after;
  Real gap;
};

/// How a node is coupled to what follows.
template <class Real>
struct NodeCouplings {
  VectorOf<Real> direction;  ///< towards the next node
  Real compliance;           ///< of the next multiplier
  Real first;                ///< to the next node: a multiple of the identity,
  MatrixOf<Real> added;      ///< and more, where something is stiffened
  Real second;               ///< to the one after
};

/// The block of a node and the multiplier before it, [[K, q], [q^T, -c]], eliminated. Its inverse is
/// [[node, cross], [cross^T, -multiplier]].
template <class Real>
struct Elimination {
  SymmetricOf<Real> node;
  VectorOf<Real> cross;
  Real multiplier;
  MatrixOf<Real> node_next;        ///< the inverse times the couplings to the next node: rows of the node,
  VectorOf<Real> multiplier_next;  ///< row of the multiplier
  VectorOf<Real> node_along;       ///< the inverse times the coupling to the next multiplier: rows of the node,
  Real multiplier_along;           ///< row of the multiplier
  VectorOf<Real> direction;
  Real first, second;
};

/// The solution of a block as far as what follows is zero.
template <class Real>
struct Forward {
  VectorOf<Real> node;
  Real multiplier;
};

/// The couplings of a cable: to next nodes by multiples of the identity; to those after them, too; and by any matrix.
enum class Couplings { plain, bending, stiffened };

template <class Real>
[[gnu::always_inline]] inline MatrixOf<Real> minus_scaled_transposed(Factor<Real> s, const MatrixOf<Real>& m) {
  return {{-s * m.row_x.x, -s * m.row_y.x, -s * m.row_z.x},
          {-s * m.row_x.y, -s * m.row_y.y, -s * m.row_z.y},
          {-s * m.row_x.z, -s * m.row_y.z, -s * m.row_z.z}};
}

template <class Real>
[[gnu::always_inline]] inline MatrixOf<Real> plus_scalar(const MatrixOf<Real>& m, Factor<Real> s) {
  return {{m.row_x.x + s, m.row_x.y, m.row_x.z}, {m.row_y.x, m.row_y.y + s, m.row_y.z}, {m.row_z.x, m.row_z.y, m.row_z.z + s}};
}

/// m + a b^T
template <class Real>
[[gnu::always_inline]] inline MatrixOf<Real> plus_outer(const MatrixOf<Real>& m, const VectorOf<Real>& a,
                                                        const VectorOf<Real>& b) {
  return {m.row_x + a.x * b, m.row_y + a.y * b, m.row_z + a.z * b};
}

/// m - a b^T, for a b^T symmetric together with what was subtracted before
template <class Real>
[[gnu::always_inline]] inline SymmetricOf<Real> minus_outer(const SymmetricOf<Real>& m, const VectorOf<Real>& a,
                                                            const VectorOf<Real>& b) {
  return {m.xx - a.x * b.x, m.xy - a.x * b.y, m.xz - a.x * b.z, m.yy - a.y * b.y, m.yz - a.y * b.z, m.zz - a.z * b.z};
}

template <class Real>
[[gnu::always_inline]] inline MatrixOf<Real> operator+(const MatrixOf<Real>& a, const MatrixOf<Real>& b) {
  return {a.row_x + b.row_x, a.row_y + b.row_y, a.row_z + b.row_z};
}

/// [q]^T M [q], where [q] v = q x v
template <class Real>
[[gnu::always_inline]] inline SymmetricOf<Real> turned_about(const VectorOf<Real>& q, const SymmetricOf<Real>& m) {
  const Real yx = m.yy * q.z - m.yz * q.y, zx = m.yz * q.z - m.zz * q.y;
  const Real xy = m.xz * q.x - m.xx * q.z, yy = m.yz * q.x - m.xy * q.z, zy = m.zz * q.x - m.xz * q.z;
  const Real xz = m.xx * q.y - m.xy * q.x, yz = m.xy * q.y - m.yy * q.x, zz = m.xz * q.y - m.yz * q.x;
  return {yx * q.z - zx * q.y, yy * q.z - zy * q.y, yz * q.z - zz * q.y,
          zy * q.x - xy * q.z, zz * q.x - xz * q.z, xz * q.y - yz * q.x};
}

/// The inverse of [[K, q], [q^T, -c]] with one division: with A the adjugate of K, a = A q and D = c det(K) + q . a, it is
/// [[c A + [q]^T K [q], a], [a^T, -det(K)]] / D. A node that is held stays where it is (`movable` is 0), and takes no multiplier.
template <class Real>
[[gnu::always_inline]] inline void invert(const SymmetricOf<Real>& k, const VectorOf<Real>& q, const Real& c, const Real& movable,
                                          Elimination<Real>& e) {
  const SymmetricOf<Real> adjugate{k.yy * k.zz - k.yz * k.yz, k.xz * k.yz - k.xy * k.zz, k.xy * k.yz - k.xz * k.yy,
                                   k.xx * k.zz - k.xz * k.xz, k.xy * k.xz - k.xx * k.yz, k.xx * k.yy - k.xy * k.xy};
  const Real determinant = k.xx * adjugate.xx + k.xy * adjugate.xy + k.xz * adjugate.xz;
  const VectorOf<Real> a = adjugate * q;
  const Real held = 1.0 - movable;
  const Real inverse = 1.0 / (movable * (c * determinant + dot(q, a)) + held * c);
  const Real scale = movable * inverse;
  e.node = times(scale, times(c, adjugate) + turned_about(q, k));
  e.cross = scale * a;
  e.multiplier = scale * determinant + held * inverse;
}

/// Of an end, before which there is nothing.
template <class Real>
[[gnu::always_inline]] inline void start(const Real& zero, Front<Real>& front) {
  const VectorOf<Real> none{zero, zero, zero};
  front.next = front.after = {zero, zero, zero, zero, zero, zero};
  front.between = {none, none, none};
  front.reach = front.beyond = none;
  front.compliance = zero + 1.0;
}

/// Eliminates a node of this own block; `front` then is that of the next one.
template <Couplings couplings, class Real>
[[gnu::always_inline]] inline void eliminate(const SymmetricOf<Real>& own, const Real& movable, const NodeCouplings<Real>& to,
                                             Front<Real>& front, Elimination<Real>& e) {
  invert(front.next + own, front.reach, front.compliance, movable, e);
  e.direction = to.direction;
  e.first = to.first;
  e.node_along = e.node * to.direction;
  e.multiplier_along = dot(e.cross, to.direction);
  front.compliance = to.compliance + dot(to.direction, e.node_along);
  if constexpr (couplings == Couplings::plain) {
    front.next = times(-to.first * to.first, e.node);
    front.reach = to.direction + to.first * e.node_along;
  } else {
    MatrixOf<Real> coupling = plus_scalar(front.between, to.first);
    if constexpr (couplings == Couplings::stiffened) coupling = coupling + to.added;
    e.second = to.second;
    e.node_next = plus_outer(e.node * coupling, e.cross, front.beyond);
    e.multiplier_next = transposed_times(coupling, e.cross) - e.multiplier * front.beyond;
    front.next = minus_outer(minus_product(front.after, coupling, e.node_next), front.beyond, e.multiplier_next);
    front.between = minus_scaled_transposed(to.second, e.node_next);
    front.after = times(-to.second * to.second, e.node);
    front.reach = to.direction + transposed_times(e.node_next, to.direction);
    front.beyond = to.second * e.node_along;
  }
}

/// The same of the right-hand sides, `own` of the node and `gap` of the next multiplier.
template <Couplings couplings, class Real>
[[gnu::always_inline]] inline void forward(const Elimination<Real>& e, const VectorOf<Real>& own, const Real& gap,
                                           FrontLoad<Real>& front, Forward<Real>& f) {
  const VectorOf<Real> load = front.next + own;
  f.node = e.node * load + front.gap * e.cross;
  f.multiplier = dot(e.cross, load) - e.multiplier * front.gap;
  if constexpr (couplings == Couplings::plain) {
    front.next = -e.first * f.node;
  } else {
    // The couplings' transpose times the inverse times the load, by the symmetry of the inverse.
    front.next = front.after - transposed_times(e.node_next, load) - front.gap * e.multiplier_next;
    front.after = -e.second * f.node;
  }
  front.gap = gap + dot(e.direction, f.node);
}

/// What is known of the solution: the next node and the one after, and the multiplier between the next node and the one that is
/// solved for now.
template <class Real>
struct Solved {
  VectorOf<Real> next, after;
  Real multiplier;
};

/// Solves for a node and the multiplier before it.
template <Couplings couplings, class Real>
[[gnu::always_inline]] inline void back(const Elimination<Real>& e, const Forward<Real>& f, Solved<Real>& solved) {
  VectorOf<Real> node = f.node + solved.multiplier * e.node_along;
  Real multiplier = f.multiplier + solved.multiplier * e.multiplier_along;
  if constexpr (couplings == Couplings::plain) {
    node = node - e.first * (e.node * solved.next);
    multiplier = multiplier - e.first * dot(e.cross, solved.next);
  } else {
    node = node - e.node_next * solved.next - e.second * (e.node * solved.after);
    multiplier = multiplier - dot(e.multiplier_next, solved.next) - e.second * dot(e.cross, solved.after);
    solved.after = solved.next;
  }
  solved.next = node;
  solved.multiplier = multiplier;
}

template <class Lanes>
[[gnu::always_inline]] inline VectorOf<double> lane_of(const VectorOf<Lanes>& v, int i) {
  return {v.x[i], v.y[i], v.z[i]};
}
template <class Lanes>
[[gnu::always_inline]] inline SymmetricOf<double> lane_of(const SymmetricOf<Lanes>& m, int i) {
  return {m.xx[i], m.xy[i], m.xz[i], m.yy[i], m.yz[i], m.zz[i]};
}
template <class Lanes>
[[gnu::always_inline]] inline Front<double> lane_of(const Front<Lanes>& front, int i) {
  return {lane_of(front.next, i),
          {lane_of(front.between.row_x, i), lane_of(front.between.row_y, i), lane_of(front.between.row_z, i)},
          lane_of(front.after, i),
          lane_of(front.reach, i),
          lane_of(front.beyond, i),
          front.compliance[i]};
}

/// What is left in the middle once both ends are eliminated up to there: two nodes, the multiplier between them and those before
/// and after them. `left` and `right` are the fronts of the two ends, seen from each.
struct MiddleElimination {
  Elimination<double> first;             ///< of the left node and the multiplier before it
  SymmetricOf<double> node;              ///< inverse of the right node's block
  VectorOf<double> reach, reach_beyond;  ///< of the right node and the multipliers before and after it
  VectorOf<double> beyond, node_beyond;  ///< of the left node and the multiplier after the right one; the inverse times it
  double multiplier_beyond;
  double own, shared, other, inverse;  ///< block of the two multipliers, and the inverse of its determinant
};

/// Eliminates the left node with the multiplier before it, then the right node; what is left are the two multipliers after them.
/// `to`: from the left node to the right one.
[[gnu::always_inline]] inline void eliminate_middle(const Front<double>& left, const Front<double>& right,
                                                    const SymmetricOf<double>& left_own, const SymmetricOf<double>& right_own,
                                                    double left_movable, double right_movable, const NodeCouplings<double>& to,
                                                    MiddleElimination& m) {
  const VectorOf<double>& p = to.direction;
  Elimination<double>& e = m.first;
  invert(left.next + right.after + left_own, left.reach, left.compliance, left_movable, e);
  const MatrixOf<double> transposed = minus_scaled_transposed(-1.0, right.between);
  const MatrixOf<double> coupling =
      plus_scalar(MatrixOf<double>{left.between.row_x + transposed.row_x, left.between.row_y + transposed.row_y,
                                   left.between.row_z + transposed.row_z},
                  to.first) +
      to.added;
  e.direction = p;
  e.node_along = e.node * p;
  e.multiplier_along = dot(e.cross, p);
  e.node_next = plus_outer(e.node * coupling, e.cross, left.beyond);
  e.multiplier_next = transposed_times(coupling, e.cross) - e.multiplier * left.beyond;
  m.beyond = right.beyond;
  m.node_beyond = e.node * m.beyond;
  m.multiplier_beyond = dot(e.cross, m.beyond);
  const SymmetricOf<double> block =
      minus_outer(minus_product(right.next + left.after + right_own, coupling, e.node_next), left.beyond, e.multiplier_next);
  m.reach = p + transposed_times(e.node_next, p);
  m.reach_beyond = right.reach - transposed_times(e.node_next, m.beyond);
  m.node = scaled_inverse(block, right_movable);
  const VectorOf<double> image = m.node * m.reach, image_beyond = m.node * m.reach_beyond;
  m.own = to.compliance + dot(p, e.node_along) + dot(m.reach, image);
  m.shared = dot(m.reach, image_beyond) - dot(m.beyond, e.node_along);
  m.other = right.compliance + dot(m.beyond, m.node_beyond) + dot(m.reach_beyond, image_beyond);
  m.inverse = 1 / (m.own * m.other - m.shared * m.shared);
}

struct MiddleSolution {
  VectorOf<double> left, right;
  double before, between, after;  ///< multipliers
};

/// For what the fronts left of the right-hand sides.
[[gnu::always_inline]] inline MiddleSolution solve_middle(const MiddleElimination& m, const VectorOf<double>& left_load,
                                                          const VectorOf<double>& right_load, double before_gap,
                                                          double between_gap, double after_gap) {
  const Elimination<double>& e = m.first;
  const VectorOf<double> node = e.node * left_load + before_gap * e.cross;
  const double multiplier = dot(e.cross, left_load) - e.multiplier * before_gap;
  const VectorOf<double> load = right_load - transposed_times(e.node_next, left_load) - before_gap * e.multiplier_next;
  const VectorOf<double> image = m.node * load;
  const double rate = dot(m.reach, image) - between_gap - dot(e.direction, node);
  const double rate_after = dot(m.reach_beyond, image) - after_gap + dot(m.beyond, node);
  MiddleSolution s;
  s.between = m.inverse * (m.other * rate - m.shared * rate_after);
  s.after = m.inverse * (m.own * rate_after - m.shared * rate);
  s.right = m.node * (load - s.between * m.reach - s.after * m.reach_beyond);
  s.left = node + s.between * e.node_along - e.node_next * s.right - s.after * m.node_beyond;
  s.before = multiplier + s.between * e.multiplier_along - dot(e.multiplier_next, s.right) - s.after * m.multiplier_beyond;
  return s;
}

}  // namespace verlet_cable

#pragma once

#include <Eigen/Core>
#include <cmath>

#include "geometry/vector_array.h"

namespace verlet_cable {

/// Two doubles that are computed with together: of two neighbouring segments or nodes, or one of the elimination that comes from
/// a cable's start, and one of that which comes from its end.
using Pair = double __attribute__((vector_size(16)));

struct PairVector {
  Pair x, y, z;
};

/// Symmetric 3 x 3.
struct PairSymmetric {
  Pair xx, xy, xz, yy, yz, zz;
};

struct PairMatrix {
  PairVector row_x, row_y, row_z;
};

inline Pair both(double value) {
  return Pair{value, value};
}

inline Pair square_root(Pair a) {
  return Pair{std::sqrt(a[0]), std::sqrt(a[1])};
}

inline Pair dot(const PairVector& a, const PairVector& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

inline PairVector operator+(const PairVector& a, const PairVector& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline PairVector operator-(const PairVector& a, const PairVector& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline PairVector operator*(Pair s, const PairVector& a) {
  return {s * a.x, s * a.y, s * a.z};
}

inline PairVector cross(const PairVector& a, const PairVector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

inline PairVector operator*(const PairSymmetric& m, const PairVector& v) {
  return {m.xx * v.x + m.xy * v.y + m.xz * v.z, m.xy * v.x + m.yy * v.y + m.yz * v.z, m.xz * v.x + m.yz * v.y + m.zz * v.z};
}

inline PairVector operator*(const PairMatrix& m, const PairVector& v) {
  return {dot(m.row_x, v), dot(m.row_y, v), dot(m.row_z, v)};
}

/// m^T v
inline PairVector transposed_times(const PairMatrix& m, const PairVector& v) {
  return v.x * m.row_x + (v.y * m.row_y + v.z * m.row_z);
}

inline PairMatrix operator*(const PairSymmetric& m, const PairMatrix& a) {
  return {m.xx * a.row_x + (m.xy * a.row_y + m.xz * a.row_z), m.xy * a.row_x + (m.yy * a.row_y + m.yz * a.row_z),
          m.xz * a.row_x + (m.yz * a.row_y + m.zz * a.row_z)};
}

/// m + s v v^T
inline PairSymmetric plus_outer(const PairSymmetric& m, Pair s, const PairVector& v) {
  const PairVector w = s * v;
  return {m.xx + w.x * v.x, m.xy + w.x * v.y, m.xz + w.x * v.z, m.yy + w.y * v.y, m.yz + w.y * v.z, m.zz + w.z * v.z};
}

inline PairSymmetric operator+(const PairSymmetric& a, const PairSymmetric& b) {
  return {a.xx + b.xx, a.xy + b.xy, a.xz + b.xz, a.yy + b.yy, a.yz + b.yz, a.zz + b.zz};
}

inline PairSymmetric times(Pair s, const PairSymmetric& m) {
  return {s * m.xx, s * m.xy, s * m.xz, s * m.yy, s * m.yz, s * m.zz};
}

/// a - b^T c for b^T c symmetric
inline PairSymmetric minus_product(const PairSymmetric& a, const PairMatrix& b, const PairMatrix& c) {
  return {a.xx - (b.row_x.x * c.row_x.x + (b.row_y.x * c.row_y.x + b.row_z.x * c.row_z.x)),
          a.xy - (b.row_x.x * c.row_x.y + (b.row_y.x * c.row_y.y + b.row_z.x * c.row_z.y)),
          a.xz - (b.row_x.x * c.row_x.z + (b.row_y.x * c.row_y.z + b.row_z.x * c.row_z.z)),
          a.yy - (b.row_x.y * c.row_x.y + (b.row_y.y * c.row_y.y + b.row_z.y * c.row_z.y)),
          a.yz - (b.row_x.y * c.row_x.z + (b.row_y.y * c.row_y.z + b.row_z.y * c.row_z.z)),
          a.zz - (b.row_x.z * c.row_x.z + (b.row_y.z * c.row_y.z + b.row_z.z * c.row_z.z))};
}

inline PairSymmetric plus_diagonal(const PairSymmetric& m, Pair s) {
  return {m.xx + s, m.xy, m.xz, m.yy + s, m.yz, m.zz + s};
}

/// `scale` times the inverse, by cofactors.
inline PairSymmetric scaled_inverse(const PairSymmetric& m, Pair scale) {
  const Pair c_xx = m.yy * m.zz - m.yz * m.yz;
  const Pair c_xy = m.xz * m.yz - m.xy * m.zz;
  const Pair c_xz = m.xy * m.yz - m.xz * m.yy;
  const Pair r = scale / (m.xx * c_xx + m.xy * c_xy + m.xz * c_xz);
  return {r * c_xx,
          r * c_xy,
          r * c_xz,
          r * (m.xx * m.zz - m.xz * m.xz),
          r * (m.xy * m.xz - m.xx * m.yz),
          r * (m.xx * m.yy - m.xy * m.xy)};
}

/// The elements of one index for the first lane, of another for the second.
inline Pair pair(const std::vector<double>& a, int i, int j) {
  return Pair{a[i], a[j]};
}
inline PairVector pair(const VectorArray& v, int i, int j) {
  return {Pair{v.x[i], v.x[j]}, Pair{v.y[i], v.y[j]}, Pair{v.z[i], v.z[j]}};
}
inline PairSymmetric pair(const SymmetricArray& m, int i, int j) {
  return {Pair{m.xx[i], m.xx[j]}, Pair{m.xy[i], m.xy[j]}, Pair{m.xz[i], m.xz[j]},
          Pair{m.yy[i], m.yy[j]}, Pair{m.yz[i], m.yz[j]}, Pair{m.zz[i], m.zz[j]}};
}

/// The elements of an index and the next.
inline Pair neighbours(const std::vector<double>& a, int i) {
  return Pair{a[i], a[i + 1]};
}
inline PairVector neighbours(const VectorArray& v, int i) {
  return pair(v, i, i + 1);
}
inline void put(Pair value, std::vector<double>& a, int i) {
  a[i] = value[0];
  a[i + 1] = value[1];
}
inline void put(const PairVector& v, VectorArray& array, int i) {
  put(v.x, array.x, i);
  put(v.y, array.y, i);
  put(v.z, array.z, i);
}
inline void put(const PairSymmetric& m, SymmetricArray& array, int i) {
  put(m.xx, array.xx, i);
  put(m.xy, array.xy, i);
  put(m.xz, array.xz, i);
  put(m.yy, array.yy, i);
  put(m.yz, array.yz, i);
  put(m.zz, array.zz, i);
}

inline Eigen::Vector3d lane(const PairVector& v, int i) {
  return {v.x[i], v.y[i], v.z[i]};
}
inline Eigen::Matrix3d lane(const PairSymmetric& m, int i) {
  Eigen::Matrix3d out;
  out << m.xx[i], m.xy[i], m.xz[i], m.xy[i], m.yy[i], m.yz[i], m.xz[i], m.yz[i], m.zz[i];
  return out;
}
inline Eigen::Matrix3d lane(const PairMatrix& m, int i) {
  Eigen::Matrix3d out;
  out << lane(m.row_x, i).transpose(), lane(m.row_y, i).transpose(), lane(m.row_z, i).transpose();
  return out;
}

}  // namespace verlet_cable

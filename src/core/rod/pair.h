#pragma once

namespace verlet_cable {

/// Two doubles that are computed with together: one belongs to the elimination that comes from a cable's start, the other to the
/// one that comes from its end.
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

}  // namespace verlet_cable

#pragma once

namespace verlet_cable {

/// Vectors and matrices of numbers of one type: `Real` is a double, a Pair, or more doubles that are computed with together. All
/// that is done with them is part of the function that does it, as files are compiled for different processors.
template <class Real>
struct VectorOf {
  Real x, y, z;
};

/// Symmetric 3 x 3.
template <class Real>
struct SymmetricOf {
  Real xx, xy, xz, yy, yz, zz;
};

template <class Real>
struct MatrixOf {
  VectorOf<Real> row_x, row_y, row_z;
};

/// A parameter that says nothing about the type of what it is multiplied with.
template <class Real>
struct Given {
  using type = Real;
};
template <class Real>
using Factor = typename Given<Real>::type;

template <class Real>
[[gnu::always_inline]] inline Real dot(const VectorOf<Real>& a, const VectorOf<Real>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class Real>
[[gnu::always_inline]] inline VectorOf<Real> operator+(const VectorOf<Real>& a, const VectorOf<Real>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class Real>
[[gnu::always_inline]] inline VectorOf<Real> operator-(const VectorOf<Real>& a, const VectorOf<Real>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class Real>
[[gnu::always_inline]] inline VectorOf<Real> operator*(Factor<Real> s, const VectorOf<Real>& a) {
  return {s * a.x, s * a.y, s * a.z};
}

template <class Real>
[[gnu::always_inline]] inline VectorOf<Real> cross(const VectorOf<Real>& a, const VectorOf<Real>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <class Real>
[[gnu::always_inline]] inline VectorOf<Real> operator*(const SymmetricOf<Real>& m, const VectorOf<Real>& v) {
  return {m.xx * v.x + m.xy * v.y + m.xz * v.z, m.xy * v.x + m.yy * v.y + m.yz * v.z, m.xz * v.x + m.yz * v.y + m.zz * v.z};
}

template <class Real>
[[gnu::always_inline]] inline VectorOf<Real> operator*(const MatrixOf<Real>& m, const VectorOf<Real>& v) {
  return {dot(m.row_x, v), dot(m.row_y, v), dot(m.row_z, v)};
}

/// m^T v
template <class Real>
[[gnu::always_inline]] inline VectorOf<Real> transposed_times(const MatrixOf<Real>& m, const VectorOf<Real>& v) {
  return v.x * m.row_x + (v.y * m.row_y + v.z * m.row_z);
}

template <class Real>
[[gnu::always_inline]] inline MatrixOf<Real> operator*(const SymmetricOf<Real>& m, const MatrixOf<Real>& a) {
  return {m.xx * a.row_x + (m.xy * a.row_y + m.xz * a.row_z), m.xy * a.row_x + (m.yy * a.row_y + m.yz * a.row_z),
          m.xz * a.row_x + (m.yz * a.row_y + m.zz * a.row_z)};
}

/// m + s v v^T
template <class Real>
[[gnu::always_inline]] inline SymmetricOf<Real> plus_outer(const SymmetricOf<Real>& m, Factor<Real> s, const VectorOf<Real>& v) {
  const VectorOf<Real> w = s * v;
  return {m.xx + w.x * v.x, m.xy + w.x * v.y, m.xz + w.x * v.z, m.yy + w.y * v.y, m.yz + w.y * v.z, m.zz + w.z * v.z};
}

template <class Real>
[[gnu::always_inline]] inline SymmetricOf<Real> operator+(const SymmetricOf<Real>& a, const SymmetricOf<Real>& b) {
  return {a.xx + b.xx, a.xy + b.xy, a.xz + b.xz, a.yy + b.yy, a.yz + b.yz, a.zz + b.zz};
}

template <class Real>
[[gnu::always_inline]] inline SymmetricOf<Real> times(Factor<Real> s, const SymmetricOf<Real>& m) {
  return {s * m.xx, s * m.xy, s * m.xz, s * m.yy, s * m.yz, s * m.zz};
}

/// a - b^T c for b^T c symmetric
template <class Real>
[[gnu::always_inline]] inline SymmetricOf<Real> minus_product(const SymmetricOf<Real>& a, const MatrixOf<Real>& b,
                                                              const MatrixOf<Real>& c) {
  return {a.xx - (b.row_x.x * c.row_x.x + (b.row_y.x * c.row_y.x + b.row_z.x * c.row_z.x)),
          a.xy - (b.row_x.x * c.row_x.y + (b.row_y.x * c.row_y.y + b.row_z.x * c.row_z.y)),
          a.xz - (b.row_x.x * c.row_x.z + (b.row_y.x * c.row_y.z + b.row_z.x * c.row_z.z)),
          a.yy - (b.row_x.y * c.row_x.y + (b.row_y.y * c.row_y.y + b.row_z.y * c.row_z.y)),
          a.yz - (b.row_x.y * c.row_x.z + (b.row_y.y * c.row_y.z + b.row_z.y * c.row_z.z)),
          a.zz - (b.row_x.z * c.row_x.z + (b.row_y.z * c.row_y.z + b.row_z.z * c.row_z.z))};
}

template <class Real>
[[gnu::always_inline]] inline SymmetricOf<Real> plus_diagonal(const SymmetricOf<Real>& m, Factor<Real> s) {
  return {m.xx + s, m.xy, m.xz, m.yy + s, m.yz, m.zz + s};
}

/// `scale` times the inverse, by cofactors.
template <class Real>
[[gnu::always_inline]] inline SymmetricOf<Real> scaled_inverse(const SymmetricOf<Real>& m, Factor<Real> scale) {
  const Real c_xx = m.yy * m.zz - m.yz * m.yz;
  const Real c_xy = m.xz * m.yz - m.xy * m.zz;
  const Real c_xz = m.xy * m.yz - m.xz * m.yy;
  const Real r = scale / (m.xx * c_xx + m.xy * c_xy + m.xz * c_xz);
  return {r * c_xx,
          r * c_xy,
          r * c_xz,
          r * (m.xx * m.zz - m.xz * m.xz),
          r * (m.xy * m.xz - m.xx * m.yz),
          r * (m.xx * m.yy - m.xy * m.xy)};
}

}  // namespace verlet_cable

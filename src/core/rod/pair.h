#pragma once

#include <Eigen/Core>
#include <cmath>

#include "geometry/lane_algebra.h"
#include "geometry/vector_array.h"

namespace verlet_cable {

/// Two doubles that are computed with together: of two neighbouring segments or nodes, or one of the elimination that comes from
/// a cable's start, and one of that which comes from its end.
using Pair = double __attribute__((vector_size(16)));

using PairVector = VectorOf<Pair>;
using PairSymmetric = SymmetricOf<Pair>;
using PairMatrix = MatrixOf<Pair>;

inline Pair both(double value) {
  return Pair{value, value};
}

inline Pair square_root(Pair a) {
  return Pair{std::sqrt(a[0]), std::sqrt(a[1])};
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

/// The symmetric parts of matrices.
inline PairSymmetric symmetric_pair(const MatrixArray& m, int i, int j) {
  const auto mean = [&](const std::vector<double>& a, const std::vector<double>& b) {
    return 0.5 * (pair(a, i, j) + pair(b, i, j));
  };
  return {pair(m.row_x.x, i, j), mean(m.row_x.y, m.row_y.x), mean(m.row_x.z, m.row_z.x),
          pair(m.row_y.y, i, j), mean(m.row_y.z, m.row_z.y), pair(m.row_z.z, i, j)};
}
/// The second lane goes the other way: from the node after to the node before.
inline PairMatrix pair_transposing_second(const MatrixArray& m, int i, int j) {
  const auto element = [&](const std::vector<double>& a, const std::vector<double>& transposed) {
    return Pair{a[i], transposed[j]};
  };
  return {{pair(m.row_x.x, i, j), element(m.row_x.y, m.row_y.x), element(m.row_x.z, m.row_z.x)},
          {element(m.row_y.x, m.row_x.y), pair(m.row_y.y, i, j), element(m.row_y.z, m.row_z.y)},
          {element(m.row_z.x, m.row_x.z), element(m.row_z.y, m.row_y.z), pair(m.row_z.z, i, j)}};
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

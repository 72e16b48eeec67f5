#pragma once

#include <cstddef>
#include <vector>

#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// Three component arrays of one vector quantity.
struct VectorArray {
  std::vector<double> x, y, z;

  void assign(std::size_t count, double value) {
    x.assign(count, value);
    y.assign(count, value);
    z.assign(count, value);
  }
};

/// Six component arrays of one symmetric matrix quantity.
struct SymmetricArray {
  std::vector<double> xx, xy, xz, yy, yz, zz;

  void assign(std::size_t count, double value) {
    for (std::vector<double>* component : {&xx, &xy, &xz, &yy, &yz, &zz}) component->assign(count, value);
  }
};

/// Nine component arrays of one matrix quantity, row by row.
struct MatrixArray {
  VectorArray row_x, row_y, row_z;

  void assign(std::size_t count, double value) {
    for (VectorArray* row : {&row_x, &row_y, &row_z}) row->assign(count, value);
  }
};

inline void add(SymmetricArray& array, int i, double scale, const Eigen::Matrix3d& m) {
  array.xx[i] += scale * m(0, 0);
  array.xy[i] += scale * m(0, 1);
  array.xz[i] += scale * m(0, 2);
  array.yy[i] += scale * m(1, 1);
  array.yz[i] += scale * m(1, 2);
  array.zz[i] += scale * m(2, 2);
}

inline Eigen::Matrix3d get(const SymmetricArray& array, int i) {
  Eigen::Matrix3d m;
  m << array.xx[i], array.xy[i], array.xz[i], array.xy[i], array.yy[i], array.yz[i], array.xz[i], array.yz[i], array.zz[i];
  return m;
}

inline void add(MatrixArray& array, int i, const Eigen::Matrix3d& m) {
  int k = 0;
  for (VectorArray* row : {&array.row_x, &array.row_y, &array.row_z}) {
    row->x[i] += m(k, 0);
    row->y[i] += m(k, 1);
    row->z[i] += m(k, 2);
    ++k;
  }
}

inline Eigen::Matrix3d get(const MatrixArray& array, int i) {
  Eigen::Matrix3d m;
  m << array.row_x.x[i], array.row_x.y[i], array.row_x.z[i], array.row_y.x[i], array.row_y.y[i], array.row_y.z[i],
      array.row_z.x[i], array.row_z.y[i], array.row_z.z[i];
  return m;
}

inline void set(VectorArray& array, int i, const Vector3& v) {
  array.x[i] = v.x();
  array.y[i] = v.y();
  array.z[i] = v.z();
}

inline Vector3 get(const VectorArray& array, int i) {
  return {array.x[i], array.y[i], array.z[i]};
}

}  // namespace verlet_cable

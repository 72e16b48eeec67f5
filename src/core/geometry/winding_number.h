#pragma once

#include <vector>

#include "verlet_cable/core/triangle_mesh.h"

namespace verlet_cable {

/// The generalized winding number of a mesh, open or not: how often it surrounds a point, 1 inside and 0 outside of what is
/// closed (Jacobson, Kavan and Sorkine-Hornung, Robust Inside-Outside Segmentation using Generalized Winding Numbers, 2013). Near
/// triangles are summed exactly; those of a node of the tree that is far away by its expansion to second order (Barill, Dickson,
/// Schmidt, Levin and Jacobson, Fast Winding Numbers for Soups and Clouds, 2018).
class WindingNumber {
 public:
  /// `triangles` in the order of the tree's leaves; `nodes`: parents before their children.
  WindingNumber(const std::vector<Vector3>& vertices, const std::vector<TriangleMesh::Triangle>& triangles,
                const std::vector<TriangleMesh::Node>& nodes);

  /// To some thousandths. `skipped`: a triangle that does not count; -1: none. The arguments are those of the constructor.
  double at(const Vector3& point, const std::vector<Vector3>& vertices, const std::vector<TriangleMesh::Triangle>& triangles,
            const std::vector<TriangleMesh::Node>& nodes, int skipped = -1) const;

 private:
  /// Of the triangles below a node.
  struct Expansion {
    Vector3 center = Vector3::Zero();                  ///< [m] of their area
    double radius = 0;                                 ///< [m] of a ball around it that holds them
    Vector3 area = Vector3::Zero();                    ///< [m^2] sum of area times normal
    Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();  ///< [m^3] sum of (their middle - center) (area times normal)'
  };

  std::vector<Expansion> expansions_;  ///< by node
};

/// Of one triangle: the solid angle that it is seen under, over 4 pi (van Oosterom and Strackee 1983). 0 of a line.
double winding_number(const Vector3& a, const Vector3& b, const Vector3& c);

}  // namespace verlet_cable

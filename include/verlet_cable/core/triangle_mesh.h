#pragma once

#include <array>
#include <string>
#include <vector>

#include "verlet_cable/core/surface_point.h"

namespace verlet_cable {

/// A solid bounded by triangles, with a tree of bounding boxes for queries. It does not change after construction; queries do not
/// allocate memory.
class TriangleMesh {
 public:
  using Triangle = std::array<int, 3>;  ///< indices of vertices, anticlockwise seen from outside

  /// `vertices` [m]. A closed mesh whose triangles all face inwards is turned inside out. Throws
  /// std::invalid_argument with the text of `problem`.
  TriangleMesh(std::vector<Vector3> vertices, std::vector<Triangle> triangles);

  /// Why the triangles do not bound a solid, empty if they do: there are none, vertices are not finite or missing, an edge is not
  /// shared by two triangles in opposite directions, or there is no volume.
  static std::string problem(const std::vector<Vector3>& vertices, const std::vector<Triangle>& triangles);

  const std::vector<Vector3>& vertices() const { return vertices_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }  ///< in the order of the tree's leaves
  const Aabb& bounds() const { return nodes_.front().box; }

  /// Exact. The sign is that of the pseudonormal, weighted by angles, of the face, edge or vertex that is nearest (Baerentzen and
  /// Aanaes, Signed Distance Computation Using the Angle Weighted Pseudonormal, 2005).
  SurfacePoint closest_point(const Vector3& point, double reach = infinity) const;
  /// Exact for a segment that does not touch the solid. Inside, where the distance along the segment may have many minima, the
  /// deepest point is found to a thousandth of the segment's length.
  SegmentSurfacePoint deepest_point(const Vector3& start, const Vector3& end, double reach = infinity) const;

 private:
  struct Node {
    Aabb box;
    int first = 0;  ///< leaf: its first triangle; else its second child, the first one follows it
    int count = 0;  ///< leaf: number of triangles; else 0
  };

  int build(int first, int last);
  void compute_normals();
  const Vector3& normal(int triangle, int feature) const;
  SurfacePoint surface_point(const Vector3& point, const Vector3& on_surface, int triangle, int feature) const;
  std::array<Vector3, 3> corners(int triangle) const;
  SegmentSurfacePoint deepest_inside(const Vector3& start, const Vector3& end) const;

  std::vector<Vector3> vertices_;
  std::vector<Triangle> triangles_;
  std::vector<Node> nodes_;
  std::vector<Vector3> vertex_normals_;  ///< unit, one a vertex
  std::vector<Vector3> edge_normals_;    ///< unit, three a triangle; the edge from corner i to corner i + 1
  std::vector<Vector3> face_normals_;    ///< unit, one a triangle
};

}  // namespace verlet_cable

#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "verlet_cable/core/surface_point.h"

namespace verlet_cable {

class WindingNumber;

/// A solid or a sheet of triangles, with a tree of bounding boxes for queries. It does not change after construction; queries do
/// not allocate memory.
class TriangleMesh {
 public:
  using Triangle = std::array<int, 3>;  ///< indices of vertices, anticlockwise seen from outside

  struct Node {
    Aabb box;
    int first = 0;  ///< leaf: its first triangle; else its second child, the first one follows it
    int count = 0;  ///< leaf: number of triangles; else 0
  };

  /// `vertices` [m]. Triangles may be open, face either way, be given twice, or share an edge with several others. Lines and
  /// copies are left out, and the others are turned as most of what hangs together faces, closed parts outwards. Throws
  /// std::invalid_argument with the text of `problem`.
  TriangleMesh(std::vector<Vector3> vertices, std::vector<Triangle> triangles);

  /// Why there is no mesh, empty if there is: it has no triangles between three vertices, or vertices are not finite or missing.
  static std::string problem(const std::vector<Vector3>& vertices, const std::vector<Triangle>& triangles);

  const std::vector<Vector3>& vertices() const { return vertices_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }  ///< in the order of the tree's leaves
  const Aabb& bounds() const { return nodes_.front().box; }
  /// Whether each edge is shared by just two triangles that face the same way, and there is a volume.
  bool is_closed() const { return !winding_; }
  /// Whether the winding number reaches 0.9 nowhere. As it is harmonic, it is largest at the surface: it is taken on both sides
  /// of the middle of triangles and of three points near their corners; of more than 5000 triangles, of every so manyth.
  bool is_sheet() const { return sheet_; }
  /// How often it surrounds a point (see WindingNumber): inside above 1/2. For meshes that are closed, 1 or 0.
  double winding_number(const Vector3& point) const;

  /// As a solid. Exact but for the sign of what is not closed, which is that of the winding number. Where the mesh is closed, it
  /// is that of the pseudonormal, weighted by angles, of the face, edge or vertex that is nearest (Baerentzen and Aanaes, Signed
  /// Distance Computation Using the Angle Weighted Pseudonormal, 2005).
  SurfacePoint closest_point(const Vector3& point, double reach = infinity) const;
  /// Exact for a segment that does not touch the solid. Inside, where the distance along the segment may have many minima, the
  /// deepest point is found to a thousandth of the segment's length.
  SegmentSurfacePoint deepest_point(const Vector3& start, const Vector3& end, double reach = infinity) const;

  /// As a sheet: no distance is below 0, and normals point to where the point is.
  SurfacePoint closest_point_of_sheet(const Vector3& point, double reach = infinity) const;
  /// Where a segment crosses the sheet, the normal points to the side where the longer part is.
  SegmentSurfacePoint closest_point_of_sheet(const Vector3& start, const Vector3& end, double reach = infinity) const;

 private:
  struct Nearest;
  struct NearestOfSegment;

  int build(int first, int last);
  void compute_normals();
  bool find_sheet() const;
  Nearest nearest(const Vector3& point) const;
  NearestOfSegment nearest(const Vector3& start, const Vector3& end) const;
  const Vector3& normal(int triangle, int feature) const;
  SurfacePoint surface_point(const Vector3& point, const Vector3& on_surface, int triangle, int feature) const;
  SurfacePoint sheet_point(const Vector3& point, const Vector3& on_surface, const Vector3& otherwise) const;
  std::array<Vector3, 3> corners(int triangle) const;
  SegmentSurfacePoint deepest_inside(const Vector3& start, const Vector3& end) const;

  std::vector<Vector3> vertices_;
  std::vector<Triangle> triangles_;
  std::vector<Node> nodes_;
  std::vector<Vector3> vertex_normals_;           ///< unit, one a vertex
  std::vector<Vector3> edge_normals_;             ///< unit, three a triangle; the edge from corner i to corner i + 1
  std::vector<Vector3> face_normals_;             ///< unit, one a triangle
  std::shared_ptr<const WindingNumber> winding_;  ///< none if the mesh is closed
  bool sheet_ = false;
};

}  // namespace verlet_cable

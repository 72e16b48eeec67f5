#include "verlet_cable/core/triangle_mesh.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "geometry/mesh_edges.h"
#include "geometry/mesh_orientation.h"
#include "geometry/triangle_geometry.h"
#include "geometry/winding_number.h"

namespace verlet_cable {

namespace {

constexpr int triangles_a_leaf = 4;
/// A mesh with a point that it surrounds by this is no sheet.
constexpr double surrounded = 0.9;
constexpr int most_samples = 5000;    // triangles
constexpr double near_corner = 0.95;  // of the way from the middle of a triangle

/// Six times the volume [m^3], below 0 where the triangles face inwards; about a corner of the mesh, for the sake of rounding.
double sixfold_volume(const std::vector<Vector3>& vertices, const std::vector<TriangleMesh::Triangle>& triangles) {
  const Vector3 origin = vertices[triangles.front()[0]];
  double sum = 0;
  for (const auto& [a, b, c] : triangles) sum += (vertices[a] - origin).dot((vertices[b] - origin).cross(vertices[c] - origin));
  return sum;
}

double angle_between(const Vector3& a, const Vector3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

void normalize(std::vector<Vector3>& normals) {
  for (Vector3& normal : normals) normal.stableNormalize();
}

}  // namespace

std::string TriangleMesh::problem(const std::vector<Vector3>& vertices, const std::vector<Triangle>& triangles) {
  const auto in_range = [&](int vertex) { return vertex >= 0 && vertex < static_cast<int>(vertices.size()); };
  bool any = false;
  for (const auto& [a, b, c] : triangles) {
    if (!in_range(a) || !in_range(b) || !in_range(c)) return "a triangle names a vertex that does not exist";
    any = any || (a != b && b != c && c != a);
  }
  if (!any) return "it has no triangles";
  for (const Vector3& vertex : vertices)
    if (!vertex.allFinite()) return "a vertex is not finite";
  return "";
}

TriangleMesh::TriangleMesh(std::vector<Vector3> vertices, std::vector<Triangle> triangles)
    : vertices_(std::move(vertices)), triangles_(std::move(triangles)) {
  if (const std::string text = problem(vertices_, triangles_); !text.empty()) throw std::invalid_argument(text);
  orient(vertices_, triangles_);
  build(0, static_cast<int>(triangles_.size()));
  compute_normals();
  if (verlet_cable::is_closed(triangles_) && sixfold_volume(vertices_, triangles_) > 0) return;
  winding_ = std::make_shared<WindingNumber>(vertices_, triangles_, nodes_);
  sheet_ = find_sheet();
}

bool TriangleMesh::find_sheet() const {
  const int count = static_cast<int>(triangles_.size());
  const int stride = 1 + (count - 1) / most_samples;
  for (int t = 0; t < count; t += stride) {
    const Corners corner = corners(t);
    const Vector3 middle = (corner[0] + corner[1] + corner[2]) / 3;
    for (int i = 0; i < 4; ++i) {
      const Vector3 point = i < 3 ? Vector3(middle + near_corner * (corner[i] - middle)) : middle;
      // On its inner side a triangle surrounds a point by a half, on the other one by minus a half.
      const double others = winding_->at(point, vertices_, triangles_, nodes_, t);
      if (0.5 + std::abs(others) >= surrounded) return false;
    }
  }
  return true;
}

double TriangleMesh::winding_number(const Vector3& point) const {
  if (winding_) return winding_->at(point, vertices_, triangles_, nodes_);
  return closest_point(point).distance < 0 ? 1 : 0;
}

Corners TriangleMesh::corners(int triangle) const {
  const auto& [a, b, c] = triangles_[triangle];
  return {vertices_[a], vertices_[b], vertices_[c]};
}

/// Builds the tree over a range of triangles, halved at the median along the longest side of its box: its depth is the logarithm
/// of their number.
int TriangleMesh::build(int first, int last) {
  const int index = static_cast<int>(nodes_.size());
  nodes_.emplace_back();
  Aabb box;
  for (int t = first; t < last; ++t)
    for (const Vector3& corner : corners(t)) box.extend(corner);
  nodes_[index].box = box;
  if (last - first <= triangles_a_leaf) {
    nodes_[index].first = first;
    nodes_[index].count = last - first;
    return index;
  }
  int axis;
  box.sizes().maxCoeff(&axis);
  const auto center = [&](const Triangle& t) { return vertices_[t[0]][axis] + vertices_[t[1]][axis] + vertices_[t[2]][axis]; };
  const int middle = (first + last) / 2;
  // Triangles at the same place are in the order of their vertices, so that the tree does not depend on the library's algorithm.
  std::nth_element(
      triangles_.begin() + first, triangles_.begin() + middle, triangles_.begin() + last,
      [&](const Triangle& a, const Triangle& b) { return std::make_pair(center(a), a) < std::make_pair(center(b), b); });
  build(first, middle);
  nodes_[index].first = build(middle, last);
  return index;
}

void TriangleMesh::compute_normals() {
  face_normals_.assign(triangles_.size(), Vector3::Zero());
  edge_normals_.assign(3 * triangles_.size(), Vector3::Zero());
  vertex_normals_.assign(vertices_.size(), Vector3::Zero());
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const Corners corner = corners(static_cast<int>(t));
    face_normals_[t] = (corner[1] - corner[0]).cross(corner[2] - corner[0]).stableNormalized();
    for (int i = 0; i < 3; ++i) {
      const Vector3 &here = corner[i], &next = corner[(i + 1) % 3], &before = corner[(i + 2) % 3];
      vertex_normals_[triangles_[t][i]] += angle_between(next - here, before - here) * face_normals_[t];
    }
  }
  for_each_edge(sorted_edges(triangles_), [&](auto first, auto end) {
    Vector3 sum = Vector3::Zero();
    for (auto edge = first; edge != end; ++edge) sum += face_normals_[edge->triangle];
    for (auto edge = first; edge != end; ++edge)
      edge_normals_[3 * edge->triangle + edge->side] = sum.isZero(0) ? face_normals_[edge->triangle] : sum;
  });
  normalize(edge_normals_);
  normalize(vertex_normals_);
}

}  // namespace verlet_cable

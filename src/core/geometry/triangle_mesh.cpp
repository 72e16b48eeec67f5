#include "verlet_cable/core/triangle_mesh.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "geometry/triangle_geometry.h"

namespace verlet_cable {

namespace {

constexpr int triangles_a_leaf = 4;

/// Six times the volume [m^3], below 0 where the triangles face inwards; about a corner of the mesh, for the sake of rounding.
double sixfold_volume(const std::vector<Vector3>& vertices, const std::vector<TriangleMesh::Triangle>& triangles) {
  const Vector3 origin = vertices[triangles.front()[0]];
  double sum = 0;
  for (const auto& [a, b, c] : triangles) sum += (vertices[a] - origin).dot((vertices[b] - origin).cross(vertices[c] - origin));
  return sum;
}

/// An edge as one of its triangles goes along it.
struct Edge {
  int from, to;
  int triangle, side;

  std::pair<int, int> key() const { return std::minmax(from, to); }
};

/// All edges, those between the same vertices side by side.
std::vector<Edge> sorted_edges(const std::vector<TriangleMesh::Triangle>& triangles) {
  std::vector<Edge> edges;
  edges.reserve(3 * triangles.size());
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t)
    for (int side = 0; side < 3; ++side) edges.push_back({triangles[t][side], triangles[t][(side + 1) % 3], t, side});
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::make_tuple(a.key(), a.triangle, a.side) < std::make_tuple(b.key(), b.triangle, b.side);
  });
  return edges;
}

double angle_between(const Vector3& a, const Vector3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

void normalize(std::vector<Vector3>& normals) {
  for (Vector3& normal : normals) normal.stableNormalize();
}

}  // namespace

std::string TriangleMesh::problem(const std::vector<Vector3>& vertices, const std::vector<Triangle>& triangles) {
  if (triangles.empty()) return "it has no triangles";
  const auto in_range = [&](int vertex) { return vertex >= 0 && vertex < static_cast<int>(vertices.size()); };
  for (const auto& [a, b, c] : triangles) {
    if (!in_range(a) || !in_range(b) || !in_range(c)) return "a triangle names a vertex that does not exist";
    if (a == b || b == c || c == a) return "a triangle has a vertex twice";
  }
  for (const Vector3& vertex : vertices)
    if (!vertex.allFinite()) return "a vertex is not finite";
  const std::vector<Edge> edges = sorted_edges(triangles);
  int open = 0;
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i;
    int balance = 0;
    for (; end < edges.size() && edges[end].key() == edges[i].key(); ++end) balance += edges[end].from < edges[end].to ? 1 : -1;
    if (end - i != 2 || balance != 0) ++open;
    i = end;
  }
  if (open > 0)
    return "it is not closed: " + std::to_string(open) + " edges are not shared by just two triangles that face the same way";
  if (!(std::abs(sixfold_volume(vertices, triangles)) > 0)) return "it encloses no volume";
  return "";
}

TriangleMesh::TriangleMesh(std::vector<Vector3> vertices, std::vector<Triangle> triangles)
    : vertices_(std::move(vertices)), triangles_(std::move(triangles)) {
  if (const std::string text = problem(vertices_, triangles_); !text.empty()) throw std::invalid_argument(text);
  if (sixfold_volume(vertices_, triangles_) < 0)
    for (Triangle& triangle : triangles_) std::swap(triangle[1], triangle[2]);
  build(0, static_cast<int>(triangles_.size()));
  compute_normals();
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
  const std::vector<Edge> edges = sorted_edges(triangles_);
  for (std::size_t i = 0; i + 1 < edges.size(); i += 2) {
    const Edge &one = edges[i], &other = edges[i + 1];
    const Vector3 sum = face_normals_[one.triangle] + face_normals_[other.triangle];
    edge_normals_[3 * one.triangle + one.side] = edge_normals_[3 * other.triangle + other.side] = sum;
  }
  normalize(edge_normals_);
  normalize(vertex_normals_);
}

}  // namespace verlet_cable

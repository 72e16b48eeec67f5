#include "geometry/winding_number.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace verlet_cable {

namespace {

/// A node is far away at so many times its radius.
constexpr double far = 4;
/// Below this part of the square of its longest edge, the area of a triangle is rounding.
constexpr double line = 1e-12;

}  // namespace

double winding_number(const Vector3& a, const Vector3& b, const Vector3& c) {
  const Vector3 first = b - a, second = c - a;
  const double longest = std::max({first.squaredNorm(), second.squaredNorm(), (c - b).squaredNorm()});
  if (!(first.cross(second).norm() > line * longest)) return 0;
  const double to_a = a.norm(), to_b = b.norm(), to_c = c.norm();
  const double angle = std::atan2(a.dot(b.cross(c)), to_a * to_b * to_c + a.dot(b) * to_c + b.dot(c) * to_a + c.dot(a) * to_b);
  return angle / (2 * M_PI);
}

WindingNumber::WindingNumber(const std::vector<Vector3>& vertices, const std::vector<TriangleMesh::Triangle>& triangles,
                             const std::vector<TriangleMesh::Node>& nodes)
    : expansions_(nodes.size()) {
  std::vector<double> areas(nodes.size(), 0);
  // First sums about the origin of the mesh's box, which are then moved to the middle of each node.
  const Vector3 origin = nodes.front().box.center();
  std::vector<Vector3> firsts(nodes.size(), Vector3::Zero());
  for (std::size_t i = nodes.size(); i-- > 0;) {
    Expansion& e = expansions_[i];
    const TriangleMesh::Node& node = nodes[i];
    for (int t = node.first; t < node.first + node.count; ++t) {
      const Vector3 a = vertices[triangles[t][0]] - origin, b = vertices[triangles[t][1]] - origin,
                    c = vertices[triangles[t][2]] - origin;
      const Vector3 area = 0.5 * (b - a).cross(c - a), middle = (a + b + c) / 3;
      const double size = area.norm();
      areas[i] += size;
      firsts[i] += size * middle;
      e.area += area;
      e.moment += middle * area.transpose();
    }
    if (node.count == 0) {
      for (const std::size_t child : {i + 1, static_cast<std::size_t>(node.first)}) {
        areas[i] += areas[child];
        firsts[i] += firsts[child];
        e.area += expansions_[child].area;
        e.moment += expansions_[child].moment;
      }
    }
  }
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    Expansion& e = expansions_[i];
    const Vector3 center = areas[i] > 0 ? Vector3(firsts[i] / areas[i]) : Vector3(nodes[i].box.center() - origin);
    e.moment -= center * e.area.transpose();
    e.center = origin + center;
    e.radius = (nodes[i].box.max() - e.center).cwiseMax(e.center - nodes[i].box.min()).norm();
  }
}

double WindingNumber::at(const Vector3& point, const std::vector<Vector3>& vertices,
                         const std::vector<TriangleMesh::Triangle>& triangles, const std::vector<TriangleMesh::Node>& nodes,
                         int skipped) const {
  std::array<int, 64> stack;
  int pending = 0;
  stack[pending++] = 0;
  double sum = 0;
  while (pending > 0) {
    const int i = stack[--pending];
    const Expansion& e = expansions_[i];
    const Vector3 arm = e.center - point;
    const double square = arm.squaredNorm();
    if (square > far * far * e.radius * e.radius) {
      const double distance = std::sqrt(square), cube = 1 / (4 * M_PI * square * distance);
      sum += cube * (arm.dot(e.area) + e.moment.trace() - 3 / square * arm.dot(e.moment * arm));
      continue;
    }
    const TriangleMesh::Node& node = nodes[i];
    for (int t = node.first; t < node.first + node.count; ++t)
      if (t != skipped)
        sum += winding_number(vertices[triangles[t][0]] - point, vertices[triangles[t][1]] - point,
                              vertices[triangles[t][2]] - point);
    if (node.count > 0) continue;
    stack[pending++] = node.first;
    stack[pending++] = i + 1;
  }
  return sum;
}

}  // namespace verlet_cable

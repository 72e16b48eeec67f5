#pragma once

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "verlet_cable/core/triangle_mesh.h"

namespace verlet_cable {

struct Triangles {
  std::vector<Vector3> vertices;
  std::vector<TriangleMesh::Triangle> triangles;

  std::shared_ptr<const TriangleMesh> mesh() const { return std::make_shared<TriangleMesh>(vertices, triangles); }
};

inline Triangles box_triangles(const Vector3& size) {
  Triangles box;
  for (int i = 0; i < 8; ++i)
    box.vertices.push_back(0.5 * size.cwiseProduct(Vector3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
  box.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                   {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return box;
}

/// A ring around z: `around` times `across` squares of two triangles.
inline Triangles torus_triangles(double ring_radius, double tube_radius, int around, int across) {
  Triangles torus;
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      const double u = 2 * M_PI * i / around, v = 2 * M_PI * j / across;
      const double from_axis = ring_radius + tube_radius * std::cos(v);
      torus.vertices.emplace_back(from_axis * std::cos(u), from_axis * std::sin(u), tube_radius * std::sin(v));
      const int here = i * across + j, up = i * across + (j + 1) % across;
      const int next = (i + 1) % around * across + j, next_up = (i + 1) % around * across + (j + 1) % across;
      torus.triangles.push_back({here, next, up});
      torus.triangles.push_back({next, next_up, up});
    }
  }
  return torus;
}

}  // namespace verlet_cable

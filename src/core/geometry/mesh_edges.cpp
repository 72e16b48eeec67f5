#include "geometry/mesh_edges.h"

#include <algorithm>
#include <tuple>

namespace verlet_cable {

std::vector<MeshEdge> sorted_edges(const std::vector<TriangleMesh::Triangle>& triangles) {
  std::vector<MeshEdge> edges;
  edges.reserve(3 * triangles.size());
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t)
    for (int side = 0; side < 3; ++side) edges.push_back({triangles[t][side], triangles[t][(side + 1) % 3], t, side});
  std::sort(edges.begin(), edges.end(), [](const MeshEdge& a, const MeshEdge& b) {
    return std::make_tuple(a.key(), a.triangle, a.side) < std::make_tuple(b.key(), b.triangle, b.side);
  });
  return edges;
}

bool is_closed(const std::vector<TriangleMesh::Triangle>& triangles) {
  bool closed = true;
  for_each_edge(sorted_edges(triangles),
                [&](auto first, auto end) { closed &= end - first == 2 && first->from != first[1].from; });
  return closed;
}

}  // namespace verlet_cable

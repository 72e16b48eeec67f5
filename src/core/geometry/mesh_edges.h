#pragma once

#include <utility>
#include <vector>

#include "verlet_cable/core/triangle_mesh.h"

namespace verlet_cable {

/// An edge as one of its triangles goes along it.
struct MeshEdge {
  int from, to;
  int triangle, side;  ///< from corner `side` to the next one

  std::pair<int, int> key() const { return std::minmax(from, to); }
};

/// All edges, those between the same vertices side by side.
std::vector<MeshEdge> sorted_edges(const std::vector<TriangleMesh::Triangle>& triangles);

/// Calls `visit` with the first and the end of the edges between the same vertices.
template <class Visitor>
void for_each_edge(const std::vector<MeshEdge>& edges, const Visitor& visit) {
  for (auto first = edges.begin(); first != edges.end();) {
    auto end = first;
    while (end != edges.end() && end->key() == first->key()) ++end;
    visit(first, end);
    first = end;
  }
}

/// Whether each edge is shared by just two triangles that go along it in opposite directions.
bool is_closed(const std::vector<TriangleMesh::Triangle>& triangles);

}  // namespace verlet_cable

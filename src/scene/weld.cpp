#include "weld.h"

#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>

namespace verlet_cable {
namespace {

using Cell = std::array<std::int64_t, 3>;

struct CellHash {
  std::size_t operator()(const Cell& cell) const {
    std::uint64_t hash = 0;
    for (const std::int64_t index : cell) hash = (hash ^ static_cast<std::uint64_t>(index)) * 0x9e3779b97f4a7c15u;
    return static_cast<std::size_t>(hash ^ (hash >> 32));
  }
};

/// Vertices in the cells of a grid.
class VertexGrid {
 public:
  explicit VertexGrid(double tolerance) : tolerance_(tolerance) {}

  /// The vertex within the tolerance that was added first; -1 if there is none.
  int find(const Vector3& at, const std::vector<Vector3>& vertices) const {
    const Cell low = cell_of(at.array() - tolerance_), high = cell_of(at.array() + tolerance_);
    int found = -1;
    Cell cell;
    for (cell[0] = low[0]; cell[0] <= high[0]; ++cell[0])
      for (cell[1] = low[1]; cell[1] <= high[1]; ++cell[1])
        for (cell[2] = low[2]; cell[2] <= high[2]; ++cell[2]) {
          const auto in_cell = cells_.find(cell);
          if (in_cell == cells_.end()) continue;
          for (const int other : in_cell->second)
            if ((found < 0 || other < found) && (vertices[other] - at).norm() <= tolerance_) found = other;
        }
    return found;
  }
  void add(const Vector3& at, int vertex) { cells_[cell_of(at)].push_back(vertex); }

 private:
  Cell cell_of(const Vector3& at) const {
    Cell cell;
    // Some tolerances wide, so that most vertices have their neighbours in one cell.
    for (int i = 0; i < 3; ++i) cell[i] = static_cast<std::int64_t>(std::floor(at[i] / (4 * tolerance_)));
    return cell;
  }

  double tolerance_;
  std::unordered_map<Cell, std::vector<int>, CellHash> cells_;
};

}  // namespace

void weld(double tolerance, std::vector<Vector3>& vertices, std::vector<TriangleMesh::Triangle>& triangles) {
  VertexGrid grid(tolerance);
  std::vector<Vector3> kept;
  std::vector<int> new_index;
  for (const Vector3& vertex : vertices) {
    int index = grid.find(vertex, kept);
    if (index < 0) {
      index = static_cast<int>(kept.size());
      kept.push_back(vertex);
      grid.add(vertex, index);
    }
    new_index.push_back(index);
  }
  std::vector<TriangleMesh::Triangle> whole;
  for (const auto& [a, b, c] : triangles) {
    const TriangleMesh::Triangle triangle{new_index[a], new_index[b], new_index[c]};
    if (triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0]) whole.push_back(triangle);
  }
  vertices = std::move(kept);
  triangles = std::move(whole);
}

}  // namespace verlet_cable

#include "geometry/mesh_orientation.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "geometry/mesh_edges.h"
#include "geometry/triangle_geometry.h"

namespace verlet_cable {

namespace {

using Triangle = TriangleMesh::Triangle;

void turn_round(Triangle& triangle) {
  std::swap(triangle[1], triangle[2]);
}

/// Volumes of what is flat are rounding below this, of the area to the power of 3/2.
constexpr double flat = 1e-9;

class Orientation {
 public:
  Orientation(const std::vector<Vector3>& vertices, std::vector<Triangle>& triangles)
      : vertices_(vertices), triangles_(triangles) {}

  void orient() {
    leave_out_copies();
    if (triangles_.empty()) return;
    given_ = triangles_;
    find_neighbours(sorted_edges(given_));
    find_parts();
    const bool closed =
        std::none_of(on_border_.begin(), on_border_.end(), [](const auto& of) { return of[0] || of[1] || of[2]; });
    if (!closed || !consistent_)
      for (const std::vector<int>& part : parts_) orient_part(part);
    double volume = 0, area = 0;
    for (const std::vector<int>& part : parts_) {
      volume += volume_of(part);
      for (const int t : part) area += area_of(t);
    }
    if (volume < -flat * std::pow(area, 1.5)) std::for_each(triangles_.begin(), triangles_.end(), turn_round);
  }

 private:
  Vector3 doubled_normal(int t) const {
    const auto& [a, b, c] = triangles_[t];
    return (vertices_[b] - vertices_[a]).cross(vertices_[c] - vertices_[a]);
  }
  double area_of(int t) const { return 0.5 * doubled_normal(t).norm(); }

  void leave_out_copies() {
    std::set<Triangle> known;
    const auto is_left_out = [&](const Triangle& triangle) {
      Triangle corners = triangle;
      std::sort(corners.begin(), corners.end());
      return corners[0] == corners[1] || corners[1] == corners[2] || !known.insert(corners).second;
    };
    triangles_.erase(std::remove_if(triangles_.begin(), triangles_.end(), is_left_out), triangles_.end());
  }

  /// Across edges of just two triangles.
  void find_neighbours(const std::vector<MeshEdge>& edges) {
    neighbours_.assign(triangles_.size(), {-1, -1, -1});
    agrees_.assign(triangles_.size(), {1, 1, 1});
    on_border_.assign(triangles_.size(), {0, 0, 0});
    for_each_edge(edges, [&](auto first, auto end) {
      if (end - first != 2) {
        for (; first != end; ++first) on_border_[first->triangle][first->side] = 1;
        return;
      }
      const MeshEdge &one = first[0], &other = first[1];
      const char agree = one.from != other.from;
      if (!agree) consistent_ = false;
      neighbours_[one.triangle][one.side] = other.triangle;
      neighbours_[other.triangle][other.side] = one.triangle;
      agrees_[one.triangle][one.side] = agrees_[other.triangle][other.side] = agree;
    });
  }

  /// What hangs together; triangles that face another way than the first of their part are noted.
  void find_parts() {
    turned_.assign(triangles_.size(), 0);
    std::vector<char> found(triangles_.size(), 0);
    for (int start = 0; start < static_cast<int>(triangles_.size()); ++start) {
      if (found[start]) continue;
      found[start] = 1;
      std::vector<int> part{start};
      for (std::size_t next = 0; next < part.size(); ++next) {
        const int t = part[next];
        for (int side = 0; side < 3; ++side) {
          const int other = neighbours_[t][side];
          if (other < 0 || found[other]) continue;
          found[other] = 1;
          turned_[other] = agrees_[t][side] ? turned_[t] : !turned_[t];
          part.push_back(other);
        }
      }
      parts_.push_back(std::move(part));
    }
  }

  void orient_part(const std::vector<int>& part) {
    double turned = 0, all = 0;
    for (const int t : part) {
      all += area_of(t);
      if (turned_[t]) turned += area_of(t);
    }
    const bool most = turned > 0.5 * all;
    bool open = false;
    for (const int t : part) {
      if ((turned_[t] != 0) != most) turn_round(triangles_[t]);
      open = open || on_border_[t][0] || on_border_[t][1] || on_border_[t][2];
    }
    if (open || !(volume_of(part) < 0)) return;
    for (const int t : part) turn_round(triangles_[t]);
  }

  /// [m^3] About the middle of its border, or a corner of it, for the sake of rounding.
  double volume_of(const std::vector<int>& part) const {
    Vector3 middle = Vector3::Zero();
    double length = 0;
    for (const int t : part)
      for (int side = 0; side < 3; ++side) {
        if (!on_border_[t][side]) continue;
        const Vector3 &from = vertices_[given_[t][side]], &to = vertices_[given_[t][(side + 1) % 3]];
        const double of_edge = (to - from).norm();
        middle += 0.5 * of_edge * (from + to);
        length += of_edge;
      }
    const Vector3 origin = length > 0 ? Vector3(middle / length) : vertices_[triangles_[part.front()][0]];
    double sixfold = 0;
    for (const int t : part) {
      const auto& [a, b, c] = triangles_[t];
      sixfold += (vertices_[a] - origin).dot((vertices_[b] - origin).cross(vertices_[c] - origin));
    }
    return sixfold / 6;
  }

  const std::vector<Vector3>& vertices_;
  std::vector<Triangle>& triangles_;
  std::vector<Triangle> given_;                 ///< as they faced at first
  std::vector<std::array<int, 3>> neighbours_;  ///< of each triangle, by its sides; -1: none, or more than one
  std::vector<std::array<char, 3>> agrees_;     ///< whether it faces the same way
  std::vector<std::array<char, 3>> on_border_;
  std::vector<char> turned_;  ///< against the first of its part
  std::vector<std::vector<int>> parts_;
  bool consistent_ = true;
};

}  // namespace

void orient(const std::vector<Vector3>& vertices, std::vector<Triangle>& triangles) {
  Orientation(vertices, triangles).orient();
}

}  // namespace verlet_cable

#include "publish/tube.h"

#include <algorithm>
#include <cmath>

#include "publish/conversions.h"
#include "verlet_cable/core/rotation.h"

namespace verlet_cable {
namespace {

constexpr int most_rings = 200;
constexpr int sides_times_rings = 700;
constexpr int fewest_sides = 6, most_sides = 8;
constexpr int sides_in_a_crowd = 4;
constexpr int corners_of_a_side = 6;  // two triangles from ring to ring

struct Detail {
  int rings;      ///< along the cable
  int sides;      ///< of a ring
  int cap_rings;  ///< of a half sphere, between its tip and its rim

  int corners() const { return corners_of_a_side * sides * (rings + 2 * cap_rings + 1); }
};

/// Fewer sides first, then tips instead of half spheres, then fewer rings.
Detail detail(std::size_t nodes, int most_corners) {
  Detail detail{static_cast<int>(std::min<std::size_t>(nodes, most_rings)), 0, 2};
  detail.sides = std::clamp(sides_times_rings / (detail.rings + 2 * detail.cap_rings + 2), fewest_sides, most_sides);
  while (detail.sides > sides_in_a_crowd && detail.corners() > most_corners) --detail.sides;
  if (detail.corners() <= most_corners) return detail;
  detail.cap_rings = 0;
  detail.rings = std::clamp(most_corners / (corners_of_a_side * detail.sides) - 1, 2, detail.rings);
  return detail;
}

/// A circle of the tube's surface.
struct Ring {
  Vector3 center;
  Quaternion orientation;  // x along the tube
  double radius;
  std_msgs::ColorRGBA color;
};

std::vector<std::size_t> evenly_spread_nodes(std::size_t nodes, std::size_t rings) {
  std::vector<std::size_t> chosen(rings);
  for (std::size_t ring = 0; ring < rings; ++ring) chosen[ring] = ring * (nodes - 1) / (rings - 1);
  return chosen;
}

/// Unit vectors from each center to the next; where two centers coincide, the direction before is kept.
std::vector<Vector3> directions_between(const std::vector<Ring>& rings) {
  std::vector<Vector3> directions(rings.size() - 1);
  Vector3 last = Vector3::UnitX();
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const Vector3 chord = rings[i + 1].center - rings[i].center;
    if (chord.squaredNorm() > 0) last = chord.normalized();
    directions[i] = last;
  }
  return directions;
}

/// Gives every ring its orientation: across the mean of the directions that meet there, turned as little as possible from ring to
/// ring.
void orient(std::vector<Ring>& rings) {
  const std::vector<Vector3> directions = directions_between(rings);
  Quaternion orientation = smallest_rotation(Vector3::UnitX(), directions.front());
  for (std::size_t i = 0; i < rings.size(); ++i) {
    const Vector3& before = directions[i == 0 ? 0 : i - 1];
    const Vector3& after = directions[std::min(i, directions.size() - 1)];
    const Vector3 sum = before + after;
    const Vector3 along = sum.squaredNorm() > 1e-12 ? sum : after;  // a fold straight back has no mean direction
    orientation = (smallest_rotation(orientation * Vector3::UnitX(), along) * orientation).normalized();
    rings[i].orientation = orientation;
  }
}

/// The rings of a half sphere on the outside of `rim`; `outwards` is +1 at the end of the tube, -1 at its start. From rim to tip.
std::vector<Ring> cap(const Ring& rim, int cap_rings, double outwards) {
  std::vector<Ring> rings;
  for (int k = 1; k <= cap_rings + 1; ++k) {
    const double latitude = M_PI_2 * k / (cap_rings + 1);
    Ring ring = rim;
    ring.center += outwards * rim.radius * std::sin(latitude) * (rim.orientation * Vector3::UnitX());
    ring.radius = rim.radius * std::cos(latitude);
    rings.push_back(ring);
  }
  return rings;
}

std::vector<Ring> make_rings(const std::vector<Vector3>& centers, const std::vector<std_msgs::ColorRGBA>& colors, double radius,
                             const Detail& detail) {
  std::vector<Ring> rings;
  for (const std::size_t node : evenly_spread_nodes(centers.size(), detail.rings)) {
    rings.push_back({centers[node], Quaternion::Identity(), radius, colors[node]});
  }
  orient(rings);
  const std::vector<Ring> start = cap(rings.front(), detail.cap_rings, -1);
  const std::vector<Ring> end = cap(rings.back(), detail.cap_rings, 1);
  rings.insert(rings.begin(), start.rbegin(), start.rend());
  rings.insert(rings.end(), end.begin(), end.end());
  return rings;
}

}  // namespace

void fill_tube(const std::vector<Vector3>& centers, const std::vector<std_msgs::ColorRGBA>& colors, double radius,
               int most_corners, visualization_msgs::Marker& marker) {
  const Detail shown = detail(centers.size(), most_corners);
  const int sides = shown.sides;
  const std::vector<Ring> rings = make_rings(centers, colors, radius, shown);
  const int ring_count = static_cast<int>(rings.size());

  std::vector<geometry_msgs::Point> surface;  // sides points a ring
  surface.reserve(rings.size() * sides);
  for (const Ring& ring : rings) {
    for (int side = 0; side < sides; ++side) {
      const double angle = 2 * M_PI * side / sides;
      const Vector3 spoke(0, ring.radius * std::cos(angle), ring.radius * std::sin(angle));
      surface.push_back(to_point(ring.center + ring.orientation * spoke));
    }
  }

  marker.points.reserve(shown.corners());
  marker.colors.reserve(shown.corners());
  const auto add_corner = [&](int ring, int side) {
    marker.points.push_back(surface[ring * sides + side % sides]);
    marker.colors.push_back(rings[ring].color);
  };
  for (int ring = 0; ring + 1 < ring_count; ++ring) {
    for (int side = 0; side < sides; ++side) {
      for (const auto& [r, s] : {std::pair(ring, side), std::pair(ring + 1, side + 1), std::pair(ring + 1, side),  //
                                 std::pair(ring, side), std::pair(ring, side + 1), std::pair(ring + 1, side + 1)}) {
        add_corner(r, s);
      }
    }
  }
}

}  // namespace verlet_cable

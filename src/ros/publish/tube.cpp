#include "publish/tube.h"

#include <algorithm>
#include <cmath>

#include "publish/conversions.h"
#include "publish/ring_choice.h"
#include "verlet_cable/core/rotation.h"

namespace verlet_cable {
namespace {

/// [m] What a pixel of rviz shows from a metre away: flat sides and straight stretches are off the round tube by no more.
constexpr double finest_detail = 0.001;
/// Of the radius: of thin tubes, that are seen from nearer.
constexpr double finest_bend = 0.03;
// An odd number of sides is about equally wide from everywhere, seven more so than twelve.
constexpr int fewest_sides = 7, most_sides = 21;
constexpr int sides_in_a_crowd = 3;
constexpr int cap_rings = 2;                // of a half sphere, between its tip and its rim
constexpr int corners_of_a_side = 6;        // two triangles from ring to ring
constexpr int most_corners_of_tube = 7500;  // 300 kB

struct Detail {
  int sides;      ///< of a ring
  int cap_rings;  ///< 0: cones
};

/// Those between the ends, and those of half spheres or cones on both.
int corners(int rings, const Detail& detail) {
  return corners_of_a_side * detail.sides * (rings + 2 * detail.cap_rings);
}

int sides_of(double radius) {
  const double half_side = std::acos(1 - std::min(finest_detail / radius, 1.0));
  const int sides = static_cast<int>(std::ceil(std::min(M_PI / half_side, 1.0 * most_sides)));
  return std::clamp(sides | 1, fewest_sides, most_sides);
}

/// [m] By which straight stretches may be off the cable.
double tolerance(double radius) {
  return std::min(finest_bend * radius, finest_detail);
}

/// Of a tube that has nothing but rings.
int most_rings(int most_corners) {
  return std::max(most_corners / corners(1, {sides_in_a_crowd, 0}), 2);
}

/// Fewer sides first, then cones instead of half spheres.
Detail detail(double radius, int rings, int most_corners) {
  Detail detail{sides_of(radius), cap_rings};
  while (detail.sides > sides_in_a_crowd && corners(rings, detail) > most_corners) detail.sides -= 2;
  if (corners(rings, detail) > most_corners) detail.cap_rings = 0;
  return detail;
}

/// Of a ring's corners to the cable's radius. Many corners are on the cable's surface; the few of a tube in a crowd are so far
/// outside that its width is right in the mean of the directions from which it is seen widest and narrowest.
double widening(int sides) {
  if (sides >= fewest_sides) return 1;
  return 4 / (1 + std::cos(M_PI / sides) + 2 * std::cos(M_PI_2 / sides));
}

/// A circle of the tube's surface.
struct Ring {
  Vector3 center;
  Quaternion orientation;  // x along the tube
  double radius;
  std_msgs::ColorRGBA color;
};

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

/// `part` of the way from the tube's rim over a half sphere of `radius` to its tip, at the end of the tube (`outwards` +1) or at
/// its start (-1).
Ring on_half_sphere(const Ring& rim, double radius, double part, double outwards) {
  Ring ring = rim;
  ring.center += outwards * radius * std::sin(M_PI_2 * part) * (rim.orientation * Vector3::UnitX());
  ring.radius *= std::cos(M_PI_2 * part);
  return ring;
}

std::vector<double> places_of_rings(const std::vector<Vector3>& centers, const std::vector<std_msgs::ColorRGBA>& colors,
                                    double radius, int most) {
  const std::vector<int> nodes = choose_rings(centers, colors, tolerance(radius), most);
  return nodes.empty() ? spread_rings(centers, most) : std::vector<double>(nodes.begin(), nodes.end());
}

std_msgs::ColorRGBA mix(const std_msgs::ColorRGBA& a, const std_msgs::ColorRGBA& b, float part) {
  std_msgs::ColorRGBA color;
  color.r = a.r + part * (b.r - a.r);
  color.g = a.g + part * (b.g - a.g);
  color.b = a.b + part * (b.b - a.b);
  color.a = a.a + part * (b.a - a.a);
  return color;
}

/// From tip to tip, which are rings without a radius.
std::vector<Ring> make_rings(const std::vector<Vector3>& centers, const std::vector<std_msgs::ColorRGBA>& colors, double radius,
                             const std::vector<double>& places, const Detail& detail) {
  std::vector<Ring> along;
  for (const double place : places) {
    const auto node = std::min(static_cast<std::size_t>(place), centers.size() - 2);
    const double part = place - static_cast<double>(node);
    along.push_back({centers[node] + part * (centers[node + 1] - centers[node]), Quaternion::Identity(),
                     widening(detail.sides) * radius, mix(colors[node], colors[node + 1], static_cast<float>(part))});
  }
  orient(along);
  const double latitudes = detail.cap_rings + 1;
  std::vector<Ring> rings;
  for (int k = detail.cap_rings + 1; k > 0; --k) rings.push_back(on_half_sphere(along.front(), radius, k / latitudes, -1));
  rings.insert(rings.end(), along.begin(), along.end());
  for (int k = 1; k <= detail.cap_rings + 1; ++k) rings.push_back(on_half_sphere(along.back(), radius, k / latitudes, 1));
  return rings;
}

}  // namespace

void fill_tube(const std::vector<Vector3>& centers, const std::vector<std_msgs::ColorRGBA>& colors, double radius,
               int most_corners, visualization_msgs::Marker& marker) {
  const int most = std::min(most_corners, most_corners_of_tube);
  const std::vector<double> places = places_of_rings(centers, colors, radius, most_rings(most));
  const Detail shown = detail(radius, static_cast<int>(places.size()), most);
  const int sides = shown.sides;
  const std::vector<Ring> rings = make_rings(centers, colors, radius, places, shown);
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

  marker.points.reserve(corners(static_cast<int>(places.size()), shown));
  marker.colors.reserve(marker.points.capacity());
  const auto add_corner = [&](int ring, int side) {
    marker.points.push_back(surface[ring * sides + side % sides]);
    marker.colors.push_back(rings[ring].color);
  };
  const auto add_triangle = [&](int ring, int side, int second_ring, int second_side, int third_ring, int third_side) {
    add_corner(ring, side);
    add_corner(second_ring, second_side);
    add_corner(third_ring, third_side);
  };
  for (int ring = 0; ring + 1 < ring_count; ++ring) {
    for (int side = 0; side < sides; ++side) {
      // At a tip one of the two has no area.
      if (ring + 2 < ring_count) add_triangle(ring, side, ring + 1, side + 1, ring + 1, side);
      if (ring > 0) add_triangle(ring, side, ring, side + 1, ring + 1, side + 1);
    }
  }
}

}  // namespace verlet_cable

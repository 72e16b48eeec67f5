#include "publish/tube.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "publish/conversions.h"
#include "publish/light.h"
#include "verlet_cable/core/rotation.h"

namespace verlet_cable {
namespace {

/// [m] What a pixel of rviz shows from a metre away: flat sides are no deeper inside the round tube.
constexpr double finest_detail = 0.0012;
/// [m] By which straight stretches may be off the cable's line; of thin tubes, that are seen from nearer, of the radius.
constexpr double finest_bend = 0.0005, finest_bend_of_radius = 0.1;
// An odd number of sides is about equally wide from everywhere, five more so than eight.
constexpr int fewest_sides = 5, most_sides = 21;
constexpr int most_cap_rings = 2;
constexpr int corners_of_a_side = 6;  // two triangles from ring to ring

/// Of a ring's corners to the tube's radius: so far outside that the tube's width is right in the mean of the directions from
/// which it is seen widest and narrowest.
double widening(int sides) {
  return 4 / (1 + std::cos(M_PI / sides) + 2 * std::cos(M_PI_2 / sides));
}

int sides_of(double radius) {
  int sides = fewest_sides;
  while (sides < most_sides && radius * (1 - widening(sides) * std::cos(M_PI / sides)) > finest_detail) sides += 2;
  return sides;
}

/// The bands of a half sphere are no deeper inside it than sides may be.
int cap_rings_of(double radius) {
  int rings = 1;
  while (rings < most_cap_rings && radius * (1 - std::cos(M_PI_4 / (rings + 1))) > finest_detail) ++rings;
  return rings;
}

/// A circle of the tube's surface.
struct Ring {
  Vector3 center;
  Quaternion orientation;  // x along the tube
  double radius;
  std_msgs::ColorRGBA color;
  double latitude = 0;  // [rad] of its normals, towards the tube's end
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
  ring.latitude = outwards * M_PI_2 * part;
  ring.center += radius * std::sin(ring.latitude) * (rim.orientation * Vector3::UnitX());
  ring.radius *= std::cos(ring.latitude);
  return ring;
}

/// From tip to tip, which are rings without a radius.
std::vector<Ring> make_rings(const std::vector<Vector3>& centers, const std::vector<std_msgs::ColorRGBA>& colors, double radius,
                             const std::vector<double>& radii, const TubeDetail& detail) {
  const auto radius_of = [&](std::size_t ring) { return radii.empty() ? radius : radii[ring]; };
  std::vector<Ring> along;
  along.reserve(detail.rings.size());
  for (std::size_t k = 0; k < detail.rings.size(); ++k) {
    const int node = detail.rings[k];
    along.push_back({centers[node], Quaternion::Identity(), widening(detail.sides) * radius_of(k), colors[node]});
  }
  orient(along);
  const double latitudes = detail.cap_rings + 1;
  std::vector<Ring> rings;
  rings.reserve(along.size() + 2 * (detail.cap_rings + 1));
  for (int k = detail.cap_rings + 1; k > 0; --k) rings.push_back(on_half_sphere(along.front(), radius_of(0), k / latitudes, -1));
  rings.insert(rings.end(), along.begin(), along.end());
  for (int k = 1; k <= detail.cap_rings + 1; ++k)
    rings.push_back(on_half_sphere(along.back(), radius_of(along.size() - 1), k / latitudes, 1));
  return rings;
}

/// Of a circle of radius 1 across x, one a side.
std::vector<Vector3> spokes(int sides) {
  std::vector<Vector3> spokes;
  for (int side = 0; side < sides; ++side) {
    const double angle = 2 * M_PI * side / sides;
    spokes.emplace_back(0, std::cos(angle), std::sin(angle));
  }
  return spokes;
}

}  // namespace

int TubeDetail::corners() const {
  return corners_of_a_side * sides * (static_cast<int>(rings.size()) + 2 * cap_rings);
}

double line_tolerance(double radius) {
  return std::min(finest_bend_of_radius * radius, finest_bend);
}

TubeDetail tube_detail(double radius, std::vector<int> rings) {
  return {std::move(rings), sides_of(radius), cap_rings_of(radius)};
}

void fill_tube(const std::vector<Vector3>& centers, const std::vector<std_msgs::ColorRGBA>& colors, double radius,
               const TubeDetail& detail, visualization_msgs::Marker& marker, const std::vector<double>& radii) {
  const int sides = detail.sides;
  const std::vector<Ring> rings = make_rings(centers, colors, radius, radii, detail);
  const int ring_count = static_cast<int>(rings.size());

  std::vector<geometry_msgs::Point> surface;  // sides points a ring, and so the colors
  std::vector<std_msgs::ColorRGBA> surface_colors;
  surface.reserve(rings.size() * sides);
  surface_colors.reserve(rings.size() * sides);
  const std::vector<Vector3> circle = spokes(sides);
  for (const Ring& ring : rings) {
    const Eigen::Matrix3d axes = ring.orientation.toRotationMatrix();
    const Vector3 along = std::sin(ring.latitude) * axes.col(0);
    for (const Vector3& spoke : circle) {
      const Vector3 across = axes * spoke;
      surface.push_back(to_point(ring.center + ring.radius * across));
      surface_colors.push_back(lit(ring.color, along + std::cos(ring.latitude) * across));
    }
  }

  marker.points.reserve(detail.corners());
  marker.colors.reserve(detail.corners());
  const auto add_corner = [&](int ring, int side) {
    const int corner = ring * sides + side % sides;
    marker.points.push_back(surface[corner]);
    marker.colors.push_back(surface_colors[corner]);
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

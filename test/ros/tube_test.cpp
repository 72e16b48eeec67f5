// The tubes that show cables: their shape, their colors, and how many triangles that takes.
#include "publish/tube.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include "publish/color.h"
#include "publish/light.h"
#include "publish/ring_choice.h"

namespace verlet_cable {
namespace {

using visualization_msgs::Marker;

// Coordinates are of order 1 and computed with some ten roundings.
constexpr double rounding = 1e-13;

Vector3 from_point(const geometry_msgs::Point& point) {
  return {point.x, point.y, point.z};
}

constexpr int any_number = 1000000;

TubeDetail detail_along(const std::vector<Vector3>& centers, const std::vector<std_msgs::ColorRGBA>& colors, double radius) {
  return tube_detail(radius, choose_rings(centers, colors, line_tolerance(radius), any_number));
}

Marker tube_along(const std::vector<Vector3>& centers, double radius) {
  Marker marker;
  const std::vector<std_msgs::ColorRGBA> colors(centers.size());
  const TubeDetail detail = detail_along(centers, colors, radius);
  fill_tube(centers, colors, radius, detail, marker);
  EXPECT_EQ(marker.points.size(), static_cast<std::size_t>(detail.corners()));
  EXPECT_EQ(marker.colors.size(), marker.points.size());
  return marker;
}

/// A polygon of so many corners, of which seen from all sides the widest and the narrowest view are in the mean as wide as a
/// circle of radius 1, has its corners so far from the middle.
double widening(int sides) {
  return 4 / (1 + std::cos(M_PI / sides) + 2 * std::cos(M_PI / (2 * sides)));
}

std::vector<Vector3> straight_line(int segments, double length) {
  std::vector<Vector3> centers;
  for (int node = 0; node <= segments; ++node) centers.emplace_back(length * node / segments, 0, 0);
  return centers;
}

/// From the origin along x, turning to z by `angle`.
std::vector<Vector3> arc(int segments, double radius, double angle) {
  std::vector<Vector3> centers;
  for (int node = 0; node <= segments; ++node) {
    const double turned = angle * node / segments;
    centers.emplace_back(radius * std::sin(turned), 0, radius * (1 - std::cos(turned)));
  }
  return centers;
}

std::vector<Vector3> coil(int segments, double radius, double pitch, double turns) {
  std::vector<Vector3> centers;
  for (int node = 0; node <= segments; ++node) {
    const double turned = turns * node / segments;
    centers.emplace_back(radius * std::sin(2 * M_PI * turned), pitch * turned, radius * std::cos(2 * M_PI * turned));
  }
  return centers;
}

std::size_t bytes(const Marker& tube) {
  return tube.points.size() * 3 * sizeof(double) + tube.colors.size() * 4 * sizeof(float);
}

double distance_to_line(const Vector3& point, const std::vector<Vector3>& line) {
  double nearest = infinity;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const Vector3 along = line[i + 1] - line[i], offset = point - line[i];
    nearest = std::min(nearest, (offset - std::clamp(offset.dot(along) / along.squaredNorm(), 0.0, 1.0) * along).norm());
  }
  return nearest;
}

/// Six times the volume that the triangles enclose, counted positive where they face outwards.
double enclosed_volume(const Marker& tube) {
  double six_volumes = 0;
  for (std::size_t i = 0; i + 2 < tube.points.size(); i += 3) {
    six_volumes += from_point(tube.points[i]).dot(from_point(tube.points[i + 1]).cross(from_point(tube.points[i + 2])));
  }
  return six_volumes / 6;
}

/// How often the directed edges between distinct corners occur, opposite directions cancelling: 0 everywhere on a closed surface.
int unmatched_edges(const Marker& tube) {
  using Corner = std::array<std::int64_t, 3>;
  const auto corner = [](const geometry_msgs::Point& p) {
    return Corner{std::llround(p.x * 1e9), std::llround(p.y * 1e9), std::llround(p.z * 1e9)};
  };
  std::map<std::pair<Corner, Corner>, int> edges;
  for (std::size_t i = 0; i + 2 < tube.points.size(); i += 3) {
    for (int k = 0; k < 3; ++k) {
      const Corner from = corner(tube.points[i + k]), to = corner(tube.points[i + (k + 1) % 3]);
      if (from < to) ++edges[{from, to}];
      if (to < from) --edges[{to, from}];
    }
  }
  int unmatched = 0;
  for (const auto& [edge, count] : edges) unmatched += std::abs(count);
  return unmatched;
}

TEST(Tube, IsClosedAndAsThickAsTheCable) {
  const double radius = 0.01, length = 1.0;
  const Marker tube = tube_along(straight_line(100, length), radius);
  EXPECT_EQ(unmatched_edges(tube), 0);
  // A prism of five corners as wide as the round cylinder has 0.88 of its volume, one of more corners more; the half spheres add
  // 1.3 % here.
  const double cylinder = M_PI * radius * radius * length;
  EXPECT_GT(enclosed_volume(tube), 0.83 * cylinder);
  EXPECT_LT(enclosed_volume(tube), 1.014 * cylinder);
}

TEST(Tube, EndsInHalfSpheres) {
  const double radius = 0.05;
  const Marker tube = tube_along(straight_line(10, 1.0), radius);
  const int sides = static_cast<int>(tube.points.size()) / 36;  // two rings, and two on each half sphere
  double first = 0, last = 0;
  for (const geometry_msgs::Point& point : tube.points) {
    first = std::min(first, point.x);
    last = std::max(last, point.x);
    const double off_the_ends = std::max({-point.x, point.x - 1, 0.0});
    const double off_the_axis = std::hypot(point.y, point.z) / widening(sides);
    EXPECT_NEAR(std::hypot(off_the_ends, off_the_axis), radius, rounding);
  }
  EXPECT_NEAR(first, -radius, rounding);
  EXPECT_NEAR(last, 1 + radius, rounding);
}

TEST(Tube, IsNotWrungByBending) {
  // In a plane, carrying a ring along leaves its spoke across the plane where it is, whatever the bends.
  std::vector<Vector3> centers{Vector3::Zero()};
  for (int node = 1; node <= 60; ++node) {
    const double heading = 1.5 * std::sin(0.2 * node);
    centers.push_back(centers.back() + 0.01 * Vector3(std::cos(heading), 0, std::sin(heading)));
  }
  const double radius = 0.002;
  const std::vector<std_msgs::ColorRGBA> colors(centers.size());
  const Marker tube = tube_along(centers, radius);
  const std::vector<int> rings = choose_rings(centers, colors, line_tolerance(radius), any_number);
  EXPECT_GT(rings.size(), centers.size() / 3);
  for (const int ring : rings) {
    const Vector3 expected = centers[ring] + widening(5) * radius * Vector3::UnitY();
    double nearest = 1;
    for (const geometry_msgs::Point& point : tube.points) nearest = std::min(nearest, (from_point(point) - expected).norm());
    EXPECT_LT(nearest, rounding);
  }
}

TEST(Tube, IsAboutAsWideAsTheCableFromEverywhere) {
  const double radius = 0.005;
  const Marker tube = tube_along(straight_line(50, 1.0), radius);
  for (double angle = 0; angle < M_PI; angle += 0.01) {
    double least = 0, most = 0;
    for (const geometry_msgs::Point& point : tube.points) {
      const double across = point.y * std::cos(angle) + point.z * std::sin(angle);
      least = std::min(least, across);
      most = std::max(most, across);
    }
    EXPECT_NEAR((most - least) / (2 * radius), 1, 0.026);
  }
}

TEST(Tube, IsClosed) {
  for (const double radius : {0.001, 0.01, 0.05}) {
    EXPECT_EQ(unmatched_edges(tube_along(arc(50, 0.3, 3), radius)), 0) << radius;
    EXPECT_EQ(unmatched_edges(tube_along(coil(100, 0.3, 0.2, 2), radius)), 0) << radius;
  }
}

TEST(Tube, SpreadRingsAreWhereItBends) {
  // Half of the nodes are on a straight line, the others go around a quarter of a circle.
  std::vector<Vector3> centers = straight_line(100, 1.0);
  for (const Vector3& point : arc(100, 0.2, M_PI_2)) centers.push_back(Vector3(1, 0, 0) + point);
  const std::vector<double> places = spread_rings(centers, 41);
  ASSERT_EQ(places.size(), 41u);
  EXPECT_EQ(places.front(), 0);
  EXPECT_EQ(places.back(), 201);
  EXPECT_TRUE(std::is_sorted(places.begin(), places.end()));
  const auto straight = std::lower_bound(places.begin(), places.end(), 99.0) - places.begin();
  EXPECT_LE(straight, 4);
  EXPECT_GE(straight, 2) << "its colors";
}

TEST(Tube, HasTheSidesThatItsRadiusTakes) {
  int before = 0;
  for (const double radius : {1e-4, 0.002, 0.005, 0.009, 0.014, 0.02, 0.05, 0.1, 1.0, 100.0}) {
    const int sides = tube_detail(radius, {0, 1}).sides;
    EXPECT_EQ(sides % 2, 1);
    EXPECT_GE(sides, std::max(5, before));
    EXPECT_LE(sides, 21);
    const double inside = radius * (1 - widening(sides) * std::cos(M_PI / sides));
    if (sides < 21) {
      EXPECT_LE(inside, std::max(0.129 * radius, 0.0012)) << radius;
    }
    before = sides;
  }
  EXPECT_EQ(tube_detail(0.009, {0, 1}).sides, 5);
  EXPECT_EQ(tube_detail(0.014, {0, 1}).sides, 7);
  EXPECT_EQ(before, 21);
}

TEST(Tube, IsNowhereFurtherFromTheRoundOneThanCanBeSeen) {
  for (const double radius : {0.002, 0.005, 0.014, 0.04})
    for (const double bend : {0.1, 0.3, 2.0})
      for (const std::vector<Vector3>& centers : {arc(100, bend, 3), arc(37, bend, 1), coil(150, bend, 0.3, 3)}) {
        if (bend < 3 * radius) continue;
        const Marker tube = tube_along(centers, radius);
        const int sides = tube_detail(radius, {0, 1}).sides;
        const double line = std::min(0.1 * radius, 0.0005);
        const double outside = (widening(sides) - 1) * radius, inside = std::min(0.129 * radius, 0.0012);
        // Of a triangle's points; the bands of the half spheres are no deeper inside than the sides. A ring across a bend is
        // narrower in the bend's plane by the cosine of half its angle, 1 - 0.03 at the sharpest.
        for (std::size_t i = 0; i + 2 < tube.points.size(); i += 3)
          for (const Vector3& weights : {Vector3(1, 1, 1), Vector3(1, 1, 0), Vector3(0, 1, 1), Vector3(1, 0, 1)}) {
            Vector3 point = Vector3::Zero();
            for (int k = 0; k < 3; ++k) point += weights[k] / weights.sum() * from_point(tube.points[i + k]);
            const double distance = distance_to_line(point, centers);
            ASSERT_LT(distance, radius + outside + line + rounding) << radius << " " << bend;
            ASSERT_GT(distance, radius - 2 * inside - line - 0.03 * radius) << radius << " " << bend;
          }
      }
}

TEST(Tube, TurnsLittleFromRingToRing) {
  // A turn of a coil as narrow as a knot is, and wider ones, of nodes enough.
  for (const double radius : {0.005, 0.014})
    for (const double bend : {4 * radius, 10 * radius, 100 * radius}) {
      const std::vector<Vector3> centers = arc(400, bend, 6);
      const std::vector<int> rings =
          choose_rings(centers, std::vector<std_msgs::ColorRGBA>(centers.size()), line_tolerance(radius), any_number);
      for (std::size_t i = 1; i < rings.size(); ++i)
        EXPECT_LT(6 * (rings[i] - rings[i - 1]) / 400.0, 0.25) << radius << " " << bend;
    }
}

TEST(Tube, TakesFewRingsWhereItIsStraight) {
  for (const double length : {0.1, 1.0, 1000.0})
    EXPECT_LE(bytes(tube_along(straight_line(1000, length), 0.01)), 40 * 6 * 7 * 4u) << length;
  // A straight line, a bend, and a straight line, of 100 nodes each.
  std::vector<Vector3> centers = straight_line(100, 1.0);
  for (const Vector3& point : arc(100, 0.1, M_PI_2)) centers.push_back(Vector3(1.01, 0, 0) + point);
  for (int node = 1; node <= 100; ++node) centers.push_back(Vector3(1.11, 0, 0.1) + Vector3(0, 0, 0.01 * node));
  const std::vector<int> rings = choose_rings(centers, std::vector<std_msgs::ColorRGBA>(centers.size()), 0.0005, 1000);
  EXPECT_LT(rings.size(), 26u);
  for (int place : {0, 200}) {
    const auto within = [&](int ring) { return ring > place + 5 && ring < place + 95; };
    EXPECT_LT(std::count_if(rings.begin(), rings.end(), within), 7) << place;
  }
}

TEST(Tube, TakesAsManyTrianglesAMetreAsRadiusAndBendAsk) {
  for (const double radius : {0.003, 0.009, 0.014})
    for (const double bend : {0.1, 0.5, 2.0})
      for (const int segments : {100, 400}) {
        const Marker tube = tube_along(arc(segments, bend, 1 / bend), radius);  // one metre
        // A straight line is off an arc by an eighth of its length squared over the radius. Equal parts, in halves and thirds,
        // are up to half more than it takes, and whole segments.
        const double part = std::min(std::sqrt(8 * bend * std::min(0.1 * radius, 0.0005)), bend / 5) - 1.0 / segments;
        const double rings = 1 + std::min(1.5 / std::max(part, 1e-9), 1.0 * segments);
        const int sides = radius < 0.0094 ? 5 : 7;
        EXPECT_LE(tube.points.size() / 3, 2 * sides * (rings + 2)) << radius << " " << bend << " " << segments;
      }
  // In numbers: taut, hanging, knotted.
  EXPECT_LE(tube_along(straight_line(100, 1.0), 0.005).points.size() / 3, 40u);
  EXPECT_LE(tube_along(arc(100, 0.3, 1 / 0.3), 0.005).points.size() / 3, 500u);
  EXPECT_LE(tube_along(arc(1000, 0.02, 1 / 0.02), 0.005).points.size() / 3, 3000u);
}

TEST(Tube, HasTheColorsOfItsNodes) {
  // Over the whole scale and back, with all its stops, and a load on one node.
  std::vector<std_msgs::ColorRGBA> colors;
  for (int node = 0; node <= 200; ++node) colors.push_back(color_of_load(1 - std::abs(node / 100.0 - 1)));
  colors[33] = color_of_load(1);
  const std::vector<Vector3> line = straight_line(200, 1.0);
  Marker tube;
  fill_tube(line, colors, 0.01, detail_along(line, colors, 0.01), tube);
  // The highest corner of each ring: along a straight tube they are all lit alike.
  const auto higher = [](const geometry_msgs::Point& a, const geometry_msgs::Point& b) { return a.z < b.z; };
  const Vector3 highest = from_point(*std::max_element(tube.points.begin(), tube.points.end(), higher));
  const Vector3 normal = Vector3(0, highest.y(), highest.z()).normalized();
  std::map<double, std_msgs::ColorRGBA> shown;
  for (std::size_t i = 0; i < tube.points.size(); ++i)
    if (tube.points[i].z > highest.z() - 1e-9) shown[std::round(1e9 * tube.points[i].x) / 1e9] = tube.colors[i];
  for (int node = 0; node <= 200; ++node) {
    const auto after = shown.lower_bound(line[node].x() - 1e-9);
    const auto before = after == shown.begin() ? after : std::prev(after);
    const double stretch = after->first - before->first;
    const double part = stretch > 0 ? std::min((line[node].x() - before->first) / stretch, 1.0) : 1;
    const std_msgs::ColorRGBA expected = lit(colors[node], normal);
    for (const auto& channel :
         {&std_msgs::ColorRGBA::r, &std_msgs::ColorRGBA::g, &std_msgs::ColorRGBA::b, &std_msgs::ColorRGBA::a})
      EXPECT_NEAR(before->second.*channel + part * (after->second.*channel - before->second.*channel), expected.*channel, 0.026)
          << node;
  }
  EXPECT_LT(tube.points.size(), 42 * 60u);
}

TEST(Tube, IsDarkerBelowThanAbove) {
  const std::vector<Vector3> line = straight_line(10, 1.0);
  const std::vector<std_msgs::ColorRGBA> colors(line.size(), color_of_load(1));
  Marker tube;
  fill_tube(line, colors, 0.01, detail_along(line, colors, 0.01), tube);
  const auto higher = [](const geometry_msgs::Point& a, const geometry_msgs::Point& b) { return a.z < b.z; };
  const auto ends = std::minmax_element(tube.points.begin(), tube.points.end(), higher);
  const std_msgs::ColorRGBA& below = tube.colors[ends.first - tube.points.begin()];
  const std_msgs::ColorRGBA& above = tube.colors[ends.second - tube.points.begin()];
  EXPECT_LT(below.r, 0.8f * above.r);
  EXPECT_GT(below.r, 0.4f * above.r);
  EXPECT_EQ(below.a, above.a);
}

TEST(Tube, SurvivesFoldsAndCoincidingNodes) {
  const std::vector<Vector3> centers{{0, 0, 0}, {1, 0, 0}, {0, 0, 0}, {0, 0, 0}, {-1, 0, 0}, {-1, 0, 0}};
  for (const geometry_msgs::Point& point : tube_along(centers, 0.1).points) ASSERT_TRUE(from_point(point).allFinite());
  for (const geometry_msgs::Point& point : tube_along({Vector3::Zero(), Vector3::Zero()}, 0.1).points) {
    ASSERT_TRUE(from_point(point).allFinite());
  }
}

}  // namespace
}  // namespace verlet_cable

// How cables are shown together: as tubes, or where these would be too many triangles as lines.
#include "publish/cable_markers.h"

#include <gtest/gtest.h>
#include <ros/serialization.h>
#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "publish/color.h"

namespace verlet_cable {
namespace {

using visualization_msgs::Marker;

constexpr double radius = 0.005;

Vector3 from_point(const geometry_msgs::Point& point) {
  return {point.x, point.y, point.z};
}

/// From the origin along x, turning to z by `angle`.
std::vector<Vector3> arc(int segments, double bend, double angle) {
  std::vector<Vector3> centers;
  for (int node = 0; node <= segments; ++node) {
    const double turned = angle * node / segments;
    centers.emplace_back(bend * std::sin(turned), 0, bend * (1 - std::cos(turned)));
  }
  return centers;
}

/// A metre that hangs in a bow, in the colors of its tension.
const std::vector<Vector3> bow = arc(50, 0.4, 2.5);

std::vector<std_msgs::ColorRGBA> colors_along(std::size_t nodes) {
  std::vector<std_msgs::ColorRGBA> colors;
  for (std::size_t node = 0; node < nodes; ++node)
    colors.push_back(color_of_load(0.2 + 0.4 * std::abs(2.0 * static_cast<double>(node) / static_cast<double>(nodes - 1) - 1)));
  return colors;
}

std::vector<Marker> bows(int count) {
  return cable_markers(std::vector<CableLook>(count, {bow, colors_along(bow.size()), radius}), MarkerStyle::tube);
}

std::size_t points(const std::vector<Marker>& markers) {
  std::size_t points = 0;
  for (const Marker& marker : markers) {
    EXPECT_EQ(marker.points.size(), marker.colors.size());
    points += marker.points.size();
  }
  return points;
}

TEST(CableMarkers, OfAFewAreTubes) {
  for (const int count : {1, 3, 10}) {
    const std::vector<Marker> markers = bows(count);
    for (const Marker& marker : markers) {
      EXPECT_EQ(marker.type, Marker::TRIANGLE_LIST);
      EXPECT_EQ(marker.scale.x * marker.scale.y * marker.scale.z, 1);
    }
    EXPECT_LE(points(markers), 1500u * count);
  }
}

TEST(CableMarkers, OfManyAreLinesAsWideAsTheCablesThatPassAllTheirNodes) {
  for (const Marker& marker : bows(100)) {
    ASSERT_EQ(marker.type, Marker::LINE_STRIP);
    EXPECT_EQ(marker.scale.x, 2 * radius);
    EXPECT_EQ(from_point(marker.points.front()), bow.front());
    EXPECT_EQ(from_point(marker.points.back()), bow.back());
    for (const Vector3& node : bow) {
      double nearest = infinity;
      for (std::size_t i = 0; i + 1 < marker.points.size(); ++i) {
        const Vector3 from = from_point(marker.points[i]), along = from_point(marker.points[i + 1]) - from;
        const double part = std::clamp((node - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
        nearest = std::min(nearest, (from + part * along - node).norm());
      }
      ASSERT_LE(nearest, 0.0005 + 1e-12);
    }
  }
}

/// Fifty times a second that is 10 MB/s, pins and names not counted.
TEST(CableMarkers, OfAHundredTakeLessThanAFifthOfAMegabyte) {
  visualization_msgs::MarkerArray message;
  message.markers = bows(100);
  EXPECT_LT(ros::serialization::serializationLength(message), 200000u);
}

TEST(CableMarkers, NeverTakeMoreThanTheyMay) {
  for (const int count : {1, 8, 9, 10, 11, 12, 13, 14, 15, 16, 20, 100, 400, 1000, 2500})
    EXPECT_LE(points(bows(count)), 15000u) << count;
  EXPECT_EQ(points(bows(4000)), 6 * 4000u);
  EXPECT_TRUE(cable_markers({}, MarkerStyle::tube).empty());
}

TEST(CableMarkers, OfAVeryLongCableStayLight) {
  std::vector<Vector3> straight, coil;
  for (int node = 0; node <= 100000; ++node) {
    straight.emplace_back(0.01 * node, 0, 0);
    const double turned = 2 * M_PI * 3000 * node / 100000.0;
    coil.emplace_back(0.5 * std::sin(turned), 6e-4 * node, 0.5 * std::cos(turned));
  }
  const std::vector<std_msgs::ColorRGBA> grey(straight.size());
  const std::vector<Marker> markers = cable_markers({{straight, grey, 0.01}, {coil, grey, 0.01}}, MarkerStyle::tube);
  EXPECT_EQ(markers[0].type, Marker::TRIANGLE_LIST);
  EXPECT_LT(markers[0].points.size(), 250u);
  EXPECT_NEAR(from_point(markers[0].points.back()).x(), 1000.0, 0.011);
  EXPECT_EQ(markers[1].type, Marker::LINE_STRIP);
  EXPECT_EQ(markers[1].points.size(), 7500u);  // 0.3 MB
  EXPECT_LT((from_point(markers[1].points.back()) - coil.back()).norm(), 1e-12);
}

TEST(CableMarkers, OfALineAreAllNodes) {
  const std::vector<Marker> markers = cable_markers({{bow, colors_along(bow.size()), radius}}, MarkerStyle::line);
  ASSERT_EQ(markers.size(), 1u);
  EXPECT_EQ(markers[0].type, Marker::LINE_STRIP);
  EXPECT_EQ(markers[0].points.size(), bow.size());
  EXPECT_EQ(markers[0].colors.size(), bow.size());
  EXPECT_EQ(markers[0].scale.x, 2 * radius);
}

TEST(CableMarkers, InACrowdMoveAsSmoothlyAsTheCable) {
  const std::vector<std_msgs::ColorRGBA> grey(51);
  const auto line = [&](double angle) {
    const std::vector<Vector3> centers = arc(50, 0.3, angle);
    return cable_markers(std::vector<CableLook>(1000, {centers, grey, radius}), MarkerStyle::tube).front();
  };
  Marker before = line(2);
  ASSERT_EQ(before.points.size(), 15u);
  for (double angle = 2; angle < 2.1; angle += 0.001) {
    const Marker marker = line(angle);
    ASSERT_EQ(marker.points.size(), before.points.size());
    for (std::size_t i = 0; i < marker.points.size(); ++i)
      ASSERT_LT((from_point(marker.points[i]) - from_point(before.points[i])).norm(), 0.001) << angle;
    before = marker;
  }
}

TEST(CableMarkers, InACrowdHaveTheColorsOfTheirNodes) {
  for (const int count : {100, 1000}) {
    const Marker marker = bows(count).front();
    const std::vector<std_msgs::ColorRGBA> colors = colors_along(bow.size());
    for (std::size_t i = 0; i < marker.points.size(); ++i) {
      double nearest = infinity;
      std_msgs::ColorRGBA wanted;
      for (std::size_t node = 0; node < bow.size(); ++node) {
        const double distance = (from_point(marker.points[i]) - bow[node]).norm();
        if (distance < nearest) nearest = distance, wanted = colors[node];
      }
      // Points are up to half a segment from the nearest node: the scale has at most 0.31 * 8 of a channel, a 62nd of it a
      // segment.
      EXPECT_NEAR(marker.colors[i].r, wanted.r, 0.04);
      EXPECT_NEAR(marker.colors[i].b, wanted.b, 0.04);
    }
  }
}

}  // namespace
}  // namespace verlet_cable

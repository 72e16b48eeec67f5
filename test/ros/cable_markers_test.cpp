// How cables are shown together: as tubes, or where these would be too many triangles as lines.
#include "publish/cable_markers.h"

#include <gtest/gtest.h>
#include <ros/serialization.h>
#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
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

/// Straight along x, as long as it has nodes, thin and from its middle on thick: there it has both ends.
TEST(CableMarkers, SectionsAreAsThickAsTheyAre) {
  std::vector<Vector3> centers;
  for (int node = 0; node <= 10; ++node) centers.emplace_back(0.1 * node, 0, 0);
  std::vector<double> radii(10, 0.005);
  std::fill(radii.begin() + 5, radii.end(), 0.02);
  const CableLook look{centers, std::vector<std_msgs::ColorRGBA>(11), 0.02, radii};
  const Marker tube = cable_markers({look}, MarkerStyle::tube).front();
  ASSERT_EQ(tube.type, Marker::TRIANGLE_LIST);
  const auto widths_at = [&](double x) {
    std::set<int> widths;  // [0.1 mm]
    for (const auto& point : tube.points)
      if (std::abs(point.x - x) < 1e-9) widths.insert(static_cast<int>(std::lround(1e4 * std::hypot(point.y, point.z))));
    return widths;
  };
  const std::set<int> thin = widths_at(0), both = widths_at(0.5), thick = widths_at(1);
  ASSERT_EQ(thin.size(), 1u);
  ASSERT_EQ(thick.size(), 1u);
  EXPECT_NEAR(*thin.begin(), 50, 4);
  EXPECT_NEAR(*thick.begin(), 200, 15);
  EXPECT_EQ(both, (std::set<int>{*thin.begin(), *thick.begin()}));
}

/// Red where the bend is as tight as it may be, blue where its radius is five times that, or the material has no smallest one.
TEST(CableMarkers, ColorsByBendAreOfTheSectionsLimits) {
  SceneDesc scene;
  scene.color_by = ColorBy::bend;
  scene.cables.emplace_back();
  auto model = std::make_shared<CableModel>();
  model->section_materials.emplace_back();
  SimulatedCable cable;
  constexpr double bend = 0.5;
  for (const Vector3& center : arc(40, bend, 1)) cable.state.positions.push_back(center);
  cable.state.rest_lengths.assign(40, bend / 40);
  cable.state.masses.assign(41, 1);
  cable.state.section_material.assign(40, 0);
  std::fill(cable.state.section_material.begin() + 20, cable.state.section_material.end(), 1);
  const auto colors = [&](double of_first, double of_second) {
    model->material.minimum_bend_radius = of_first;
    model->section_materials[0].material.minimum_bend_radius = of_second;
    cable.model = model;
    return ColorScale(scene).node_colors(cable, {});
  };
  const std::vector<std_msgs::ColorRGBA> shown = colors(1.01 * bend, bend / 5.1), none = colors(0, 1.01 * bend);
  EXPECT_EQ(shown[0], color_of_load(1));
  EXPECT_EQ(shown[10], color_of_load(1));
  EXPECT_EQ(shown[30], color_of_load(0));
  EXPECT_EQ(none[10], color_of_load(0));
  EXPECT_EQ(none[40], color_of_load(1));
  const Legend legend = ColorScale(scene).legend();
  EXPECT_EQ(legend.quantity, "bend radius / smallest allowed");
  EXPECT_EQ(legend.values.front(), 1);
  EXPECT_EQ(legend.values.back(), 5);
  EXPECT_TRUE(std::is_sorted(legend.values.begin(), legend.values.end()));
  EXPECT_EQ(legend.colors.front(), color_of_load(1));
}

}  // namespace
}  // namespace verlet_cable

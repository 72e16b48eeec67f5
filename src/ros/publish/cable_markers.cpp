#include "publish/cable_markers.h"

#include <algorithm>
#include <utility>

#include "publish/conversions.h"
#include "publish/ring_choice.h"
#include "publish/tube.h"

namespace verlet_cable {
namespace {

using visualization_msgs::Marker;

constexpr int most_points = 15000;        // of all cables: 0.6 MB, that a network and rviz take 50 times a second
constexpr int most_points_of_one = 7500;  // 0.3 MB
constexpr int fewest_points = 6;          // of a line, however many there are

std_msgs::ColorRGBA mix(const std_msgs::ColorRGBA& a, const std_msgs::ColorRGBA& b, float part) {
  std_msgs::ColorRGBA color;
  color.r = a.r + part * (b.r - a.r);
  color.g = a.g + part * (b.g - a.g);
  color.b = a.b + part * (b.b - a.b);
  color.a = a.a + part * (b.a - a.a);
  return color;
}

/// A marker of a type, with its color for viewers that know no colors of points.
Marker marker_of(const CableLook& cable, int type) {
  Marker marker;
  marker.type = type;
  marker.color = cable.colors.front();
  return marker;
}

Marker tube(const CableLook& cable, const TubeDetail& detail) {
  Marker marker = marker_of(cable, Marker::TRIANGLE_LIST);
  marker.scale.x = marker.scale.y = marker.scale.z = 1;
  fill_tube(cable.centers, cable.colors, cable.radius, detail, marker);
  return marker;
}

Marker line(const CableLook& cable) {
  Marker marker = marker_of(cable, Marker::LINE_STRIP);
  marker.scale.x = 2 * cable.radius;
  for (const Vector3& center : cable.centers) marker.points.push_back(to_point(center));
  marker.colors = cable.colors;
  return marker;
}

/// Through places, the first center being 0 and the middle between it and the next 0.5.
Marker line(const CableLook& cable, const std::vector<double>& places) {
  Marker marker = marker_of(cable, Marker::LINE_STRIP);
  marker.scale.x = 2 * cable.radius;
  for (const double place : places) {
    const std::size_t node = std::min(static_cast<std::size_t>(place), cable.centers.size() - 2);
    const double part = place - static_cast<double>(node);
    marker.points.push_back(to_point(cable.centers[node] + part * (cable.centers[node + 1] - cable.centers[node])));
    marker.colors.push_back(mix(cable.colors[node], cable.colors[node + 1], static_cast<float>(part)));
  }
  return marker;
}

/// In place of a tube that would have these rings; none: they would be too many.
Marker line(const CableLook& cable, const std::vector<int>& rings, int most) {
  const bool fits = !rings.empty() && static_cast<int>(rings.size()) <= most;
  return line(cable, fits ? std::vector<double>(rings.begin(), rings.end()) : spread_rings(cable.centers, most));
}

}  // namespace

std::vector<Marker> cable_markers(const std::vector<CableLook>& cables, MarkerStyle style) {
  std::vector<Marker> markers;
  markers.reserve(cables.size());
  if (style == MarkerStyle::line) {
    for (const CableLook& cable : cables) markers.push_back(line(cable));
    return markers;
  }
  std::vector<TubeDetail> details;
  details.reserve(cables.size());
  const auto can_be_tube = [](const TubeDetail& detail) {
    return !detail.rings.empty() && detail.corners() <= most_points_of_one;
  };
  int corners = 0;
  for (const CableLook& cable : cables) {
    details.push_back(
        tube_detail(cable.radius, choose_rings(cable.centers, cable.colors, line_tolerance(cable.radius), most_points_of_one)));
    if (can_be_tube(details.back())) corners += details.back().corners();
  }
  const int most_of_line =
      std::clamp(most_points / static_cast<int>(std::max<std::size_t>(cables.size(), 1)), fewest_points, most_points_of_one);
  for (std::size_t i = 0; i < cables.size(); ++i)
    markers.push_back(corners <= most_points && can_be_tube(details[i]) ? tube(cables[i], details[i])
                                                                        : line(cables[i], details[i].rings, most_of_line));
  return markers;
}

}  // namespace verlet_cable

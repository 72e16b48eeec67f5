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

/// The rings of a tube, see choose_rings; where its radius changes, two at that node.
std::vector<int> rings_of(const CableLook& cable) {
  const double tolerance = line_tolerance(cable.radius);
  if (cable.segment_radii.empty()) return choose_rings(cable.centers, cable.colors, tolerance, most_points_of_one);
  std::vector<int> rings;
  const int segments = static_cast<int>(cable.segment_radii.size());
  for (int first = 0, last; first < segments; first = last) {
    last = first + 1;
    while (last < segments && cable.segment_radii[last] == cable.segment_radii[first]) ++last;
    const std::vector<Vector3> centers(cable.centers.begin() + first, cable.centers.begin() + last + 1);
    const std::vector<std_msgs::ColorRGBA> colors(cable.colors.begin() + first, cable.colors.begin() + last + 1);
    const std::vector<int> stretch = choose_rings(centers, colors, tolerance, most_points_of_one);
    if (stretch.empty()) return {};
    for (const int ring : stretch) rings.push_back(first + ring);
  }
  return rings;
}

/// [m] Of each ring: the first of two at a node ends what is before it.
std::vector<double> ring_radii(const CableLook& cable, const std::vector<int>& rings) {
  std::vector<double> radii;
  for (std::size_t k = 0; k < rings.size() && !cable.segment_radii.empty(); ++k) {
    const bool ends = k > 0 && (k + 1 == rings.size() || rings[k + 1] == rings[k]);
    radii.push_back(cable.segment_radii[rings[k] - (ends ? 1 : 0)]);
  }
  return radii;
}

Marker tube(const CableLook& cable, const TubeDetail& detail) {
  Marker marker = marker_of(cable, Marker::TRIANGLE_LIST);
  marker.scale.x = marker.scale.y = marker.scale.z = 1;
  fill_tube(cable.centers, cable.colors, cable.radius, detail, marker, ring_radii(cable, detail.rings));
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
    details.push_back(tube_detail(cable.radius, rings_of(cable)));
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

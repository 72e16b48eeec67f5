#include "requests/location.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>

#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/quoted_text.h"
#include "verlet_cable/core/scene_fields.h"

namespace verlet_cable {
namespace {

/// What the three ways to give a place have in common: the point on the cable.
struct PointOnCable {
  int cable = -1;
  int segment = 0;
  double fraction = 0;  ///< along the segment
  double distance = 0;  ///< [m] from the given point
  std::string field;    ///< that gave it, and its value
  std::vector<std::string> errors;
};

std::string point_text(const geometry_msgs::Point& point) {
  return "(" + number_text(point.x) + ", " + number_text(point.y) + ", " + number_text(point.z) + ")";
}

/// `bodies`: whether those may be named, too.
void find_cable(const CableLocation& location, const World& world, bool bodies, PointOnCable& found) {
  if (location.cable.empty() && location.mode == CableLocation::NEAREST) return;
  found.cable = find(world.cables(), location.cable);
  if (found.cable >= 0) return;
  const std::vector<std::string>& waiting = world.findings().waiting;
  if (std::find(waiting.begin(), waiting.end(), location.cable) != waiting.end()) {
    found.errors.push_back("location.cable: " + quoted(location.cable) +
                           " waits for its tf frames; allowed: cables that are simulated already");
    return;
  }
  std::string names;
  for (const SimulatedCable& cable : world.cables()) names += (names.empty() ? "" : ", ") + cable.model->name;
  for (const SimulatedNet& net : world.nets()) names += (names.empty() ? "" : ", ") + net.model.name;
  if (bodies)
    for (const SimulatedBody& body : world.bodies())
      if (!body.is_junction) names += (names.empty() ? "" : ", ") + body.name;
  found.errors.push_back("location.cable: " + quoted(location.cable) +
                         "; allowed: " + (names.empty() ? "none, there are no cables or nets" : names));
}

void find_node(const CableLocation& location, const World& world, PointOnCable& found) {
  found.field = "location.node: " + std::to_string(location.node);
  if (found.cable < 0) return;
  const auto segments = static_cast<std::uint32_t>(world.cables()[found.cable].state.segments());
  if (location.node > segments) {
    found.errors.push_back(found.field + "; allowed: 0 to " + std::to_string(segments));
    return;
  }
  found.segment = static_cast<int>(std::min(location.node, segments - 1));
  found.fraction = location.node == segments ? 1 : 0;
}

void find_arc_length(const CableLocation& location, const World& world, PointOnCable& found) {
  found.field = "location.arc_length: " + number_text(location.arc_length);
  if (found.cable < 0) {
    if (!std::isfinite(location.arc_length)) found.errors.push_back(found.field + "; allowed: finite numbers [m]");
    return;
  }
  const CableState& state = world.cables()[found.cable].state;
  const std::vector<double> arc_length = state.arc_length();
  // The end is a sum, rounded.
  constexpr double rounding = 1e-9;
  if (!(location.arc_length >= 0 && location.arc_length <= arc_length.back() * (1 + rounding))) {
    found.errors.push_back(found.field + "; allowed: 0 to " + rounded_text(arc_length.back()) + " m");
    return;
  }
  const auto after = std::upper_bound(arc_length.begin(), arc_length.end(), location.arc_length);
  found.segment = std::min(static_cast<int>(std::distance(arc_length.begin(), after)), state.segments()) - 1;
  found.fraction = (location.arc_length - arc_length[found.segment]) / state.rest_lengths[found.segment];
}

/// The point of NEAREST in the fixed frame; what is wrong with it is added to `errors`.
std::optional<Vector3> read_point(const CableLocation& location, const FindFrame& find_frame, std::vector<std::string>& errors) {
  const geometry_msgs::Point& point = location.point.point;
  const std::size_t before = errors.size();
  if (!coordinate.contains(point.x) || !coordinate.contains(point.y) || !coordinate.contains(point.z)) {
    errors.push_back("location.point.point: " + point_text(point) + "; allowed: " + coordinate.text("m"));
  }
  const std::string& frame = location.point.header.frame_id;
  const std::optional<Pose> pose = frame.empty() ? Pose{} : find_frame(frame);
  if (!pose) errors.push_back("location.point.header.frame_id: " + quoted(frame) + "; allowed: frames that tf knows");
  if (errors.size() > before) return std::nullopt;
  return (*pose * Pose{Vector3(point.x, point.y, point.z), Quaternion::Identity()}).position;
}

void find_nearest(const CableLocation& location, const World& world, const FindFrame& find_frame, PointOnCable& found) {
  found.field = "location.point: " + point_text(location.point.point);
  const std::optional<Vector3> position = read_point(location, find_frame, found.errors);
  if (!found.errors.empty()) return;
  if (world.cables().empty()) found.errors.push_back("location.cable: \"\"; allowed: none, there are no cables");

  double least = infinity;
  const bool any = found.cable < 0;
  const int first = any ? 0 : found.cable, last = any ? static_cast<int>(world.cables().size()) - 1 : found.cable;
  for (int cable = first; cable <= last; ++cable) {
    const NearestPoint nearest = nearest_point(world.cables()[cable].state, *position);
    // Squares of far points overflow: then one cable is as near as another.
    if (found.cable >= 0 && !(nearest.distance < least)) continue;
    least = nearest.distance;
    found.cable = cable;
    found.distance = nearest.distance;
    found.segment = nearest.segment;
    found.fraction = nearest.fraction;
  }
}

PointOnCable find_point(const CableLocation& location, const World& world, const FindFrame& find_frame, bool bodies) {
  PointOnCable found;
  find_cable(location, world, bodies, found);
  switch (location.mode) {
    case CableLocation::NODE:
      find_node(location, world, found);
      break;
    case CableLocation::ARC_LENGTH:
      find_arc_length(location, world, found);
      break;
    case CableLocation::NEAREST:
      find_nearest(location, world, find_frame, found);
      break;
    default:
      found.errors.push_back("location.mode: " + std::to_string(location.mode) +
                             "; allowed: 0 (NODE), 1 (ARC_LENGTH), 2 (NEAREST)");
  }
  return found;
}

/// The distance of a point to the nearest node of a net [m].
double distance(const SimulatedNet& net, const Vector3& point) {
  return (net.state.positions[nearest_node(net, point)] - point).norm();
}

/// The net that a location means, -1 if it means a cable: by its name, or as what is nearest of all.
int find_net(const CableLocation& location, const World& world, const FindFrame& find_frame) {
  if (!location.cable.empty() || location.mode != CableLocation::NEAREST) return find(world.nets(), location.cable);
  std::vector<std::string> errors;
  const std::optional<Vector3> point = read_point(location, find_frame, errors);
  if (!point) return -1;
  double least = infinity;
  for (const SimulatedCable& cable : world.cables()) least = std::min(least, nearest_point(cable.state, *point).distance);
  int nearest = -1;
  for (int net = 0; net < static_cast<int>(world.nets().size()); ++net) {
    if (!(distance(world.nets()[net], *point) < least)) continue;
    least = distance(world.nets()[net], *point);
    nearest = net;
  }
  return nearest;
}

/// The node of a net that a location means. Other than for cables there is no arc length.
Location locate_net_node(const CableLocation& location, const World& world, int index, const FindFrame& find_frame) {
  const SimulatedNet& net = world.nets()[index];
  Location found;
  found.body = net_id(index);
  if (location.mode == CableLocation::NODE) {
    found.node = static_cast<int>(std::min<std::uint32_t>(location.node, net.model.nodes()));
    if (found.node == net.model.nodes())
      found.errors.push_back("location.node: " + std::to_string(location.node) + "; allowed: 0 to " +
                             std::to_string(net.model.nodes() - 1));
  } else if (location.mode == CableLocation::NEAREST) {
    const std::optional<Vector3> point = read_point(location, find_frame, found.errors);
    if (point) {
      found.node = nearest_node(net, *point);
      found.distance = distance(net, *point);
    }
  } else {
    found.errors.push_back("location.mode: " + std::to_string(location.mode) + " for net " + quoted(net.model.name) +
                           "; allowed: 0 (NODE), 2 (NEAREST)");
  }
  return found;
}

Location locate_links(const CableLocation& location, const World& world, int index, const FindFrame& find_frame) {
  const SimulatedNet& net = world.nets()[index];
  Location found = locate_net_node(location, world, index, find_frame);
  if (!found.errors.empty()) return found;
  if (location.mode == CableLocation::NEAREST) {
    const NearestPoint nearest = nearest_link(net, *read_point(location, find_frame, found.errors));
    if (nearest.segment >= 0) found.elements.push_back(nearest.segment);
    found.distance = nearest.distance;
  } else {
    for (int link = 0; link < static_cast<int>(net.model.links.size()); ++link)
      if (net.model.links[link][0] == found.node || net.model.links[link][1] == found.node) found.elements.push_back(link);
  }
  if (found.elements.empty())
    found.errors.push_back("location: net " + quoted(net.model.name) + " has no link there; allowed: nodes that links join");
  return found;
}

/// The origin of a body's frame.
Location locate_body(const CableLocation& location, const World& world, int index) {
  Location found;
  found.body = rigid_body_id(index);
  if (!world.frame_known(world.bodies()[index].frame))
    found.errors.push_back("location.cable: " + quoted(world.bodies()[index].name) +
                           " waits for its tf frames; allowed: bodies that are simulated already");
  else if (location.mode != CableLocation::NODE)
    found.errors.push_back("location.mode: " + std::to_string(location.mode) + " for body " + quoted(world.bodies()[index].name) +
                           "; allowed: 0 (NODE)");
  else if (location.node != 0)
    found.errors.push_back("location.node: " + std::to_string(location.node) + "; allowed: 0, the origin of the body's frame");
  return found;
}

}  // namespace

Location locate_node(const CableLocation& location, const World& world, const FindFrame& find_frame) {
  if (const int net = find_net(location, world, find_frame); net >= 0) return locate_net_node(location, world, net, find_frame);
  if (const int body = find(world.bodies(), location.cable); body >= 0) return locate_body(location, world, body);
  const PointOnCable found = find_point(location, world, find_frame, true);
  return {cable_id(found.cable), found.segment + (found.fraction > 0.5 ? 1 : 0), {}, found.distance, found.errors};
}

Location locate_cut(const CableLocation& location, const World& world, const FindFrame& find_frame) {
  if (const int net = find_net(location, world, find_frame); net >= 0) return locate_links(location, world, net, find_frame);
  PointOnCable found = find_point(location, world, find_frame, false);
  if (found.errors.empty()) {
    const SimulatedCable& cable = world.cables()[found.cable];
    const int last = cable.state.segments() - 2;
    const bool behind_the_end = location.mode == CableLocation::NODE && found.fraction > 0;
    if (last < 1) {
      found.errors.push_back("location.cable: " + quoted(cable.model->name) + " of " + std::to_string(cable.state.segments()) +
                             " segments; allowed: cables of at least 3, so that each piece keeps one");
    } else if (found.segment < 1 || found.segment > last || behind_the_end) {
      found.errors.push_back(
          found.field + " means " + (behind_the_end ? "no segment" : "segment " + std::to_string(found.segment)) + " of cable " +
          quoted(cable.model->name) + "; allowed: segments 1 to " + std::to_string(last) + ", so that each piece keeps one");
    }
  }
  return {cable_id(found.cable), found.segment, {found.segment}, found.distance, found.errors};
}

}  // namespace verlet_cable

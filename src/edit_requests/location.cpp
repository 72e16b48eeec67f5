#include "edit_requests/location.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>

#include "edit_requests/error_text.h"
#include "verlet_cable/core/name_list.h"
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

/// "location.mode: 1", or the argument that says so.
std::string mode_text(const RequestedPlace& place) {
  const RequestWords& words = *place.words;
  return words.mode.empty() ? words.mode_names.at(static_cast<std::size_t>(place.mode))
                            : words.mode + ": " + std::to_string(place.mode);
}

/// `bodies`: whether those may be named, too.
void find_cable(const RequestedPlace& place, const World& world, bool bodies, PointOnCable& found) {
  if (place.cable.empty() && place.mode == RequestedPlace::nearest) return;
  found.cable = find(world.cables(), place.cable);
  if (found.cable >= 0) return;
  if (const auto waits = why_cable_waits(world, place.words->cable, place.cable, *place.words))
    return found.errors.push_back(*waits);
  NameList names;
  for (const SimulatedCable& cable : world.cables()) names.add(cable.model->name);
  for (const SimulatedNet& net : world.nets()) names.add(net.model.name);
  if (bodies)
    for (const SimulatedBody& body : world.bodies())
      if (!body.is_junction) names.add(body.name);
  found.errors.push_back(place.words->cable + ": " + in_quotes(place.cable) +
                         "; allowed: " + names.text("none, there are no cables or nets"));
}

void find_node(const RequestedPlace& place, const World& world, PointOnCable& found) {
  found.field = place.words->node + ": " + std::to_string(place.node);
  if (found.cable < 0) return;
  const std::int64_t segments = world.cables()[found.cable].state.segments();
  if (place.node < 0 || place.node > segments) {
    found.errors.push_back(found.field + "; allowed: 0 to " + std::to_string(segments));
    return;
  }
  found.segment = static_cast<int>(std::min(place.node, segments - 1));
  found.fraction = place.node == segments ? 1 : 0;
}

void find_arc_length(const RequestedPlace& place, const World& world, PointOnCable& found) {
  found.field = place.words->arc_length + ": " + number_text(place.arc_length);
  if (found.cable < 0) {
    if (!std::isfinite(place.arc_length)) found.errors.push_back(found.field + "; allowed: finite numbers [m]");
    return;
  }
  const CableState& state = world.cables()[found.cable].state;
  const std::vector<double> arc_length = state.arc_length();
  // The end is a sum, rounded.
  constexpr double rounding = 1e-9;
  if (!(place.arc_length >= 0 && place.arc_length <= arc_length.back() * (1 + rounding))) {
    found.errors.push_back(found.field + "; allowed: 0 to " + rounded_text(arc_length.back()) + " m");
    return;
  }
  const auto after = std::upper_bound(arc_length.begin(), arc_length.end(), place.arc_length);
  found.segment = std::min(static_cast<int>(std::distance(arc_length.begin(), after)), state.segments()) - 1;
  found.fraction = (place.arc_length - arc_length[found.segment]) / state.rest_lengths[found.segment];
}

/// The point of `nearest` in the fixed frame; what is wrong with it is added to `errors`.
std::optional<Vector3> read_point(const RequestedPlace& place, const FindFrame& find_frame, std::vector<std::string>& errors) {
  const Vector3& point = place.point;
  const std::size_t before = errors.size();
  if (!coordinate.contains(point.x()) || !coordinate.contains(point.y()) || !coordinate.contains(point.z())) {
    errors.push_back(place.words->point_numbers + ": " + point_text(point) + "; allowed: " + coordinate.text("m"));
  }
  const std::string& frame = place.point_frame;
  const std::optional<Pose> pose = frame.empty() ? Pose{} : find_frame(frame);
  if (!pose) errors.push_back(place.words->point_frame + ": " + in_quotes(frame) + "; allowed: known frames");
  if (errors.size() > before) return std::nullopt;
  return (*pose * Pose{point, Quaternion::Identity()}).position;
}

void find_nearest(const RequestedPlace& place, const World& world, const FindFrame& find_frame, PointOnCable& found) {
  found.field = place.words->point + ": " + point_text(place.point);
  const std::optional<Vector3> position = read_point(place, find_frame, found.errors);
  if (!found.errors.empty()) return;
  if (world.cables().empty()) found.errors.push_back(place.words->cable + ": \"\"; allowed: none, there are no cables");

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

PointOnCable find_point(const RequestedPlace& place, const World& world, const FindFrame& find_frame, bool bodies) {
  PointOnCable found;
  const std::array<std::string, 3>& mode_names = place.words->mode_names;
  find_cable(place, world, bodies, found);
  switch (place.mode) {
    case RequestedPlace::at_node:
      find_node(place, world, found);
      break;
    case RequestedPlace::at_arc_length:
      find_arc_length(place, world, found);
      break;
    case RequestedPlace::nearest:
      find_nearest(place, world, find_frame, found);
      break;
    default:
      found.errors.push_back(mode_text(place) + "; allowed: " + mode_names[0] + ", " + mode_names[1] + ", " + mode_names[2]);
  }
  return found;
}

/// The distance of a point to the nearest node of a net [m].
double distance(const SimulatedNet& net, const Vector3& point) {
  return (net.state.positions[nearest_node(net, point)] - point).norm();
}

/// The net that a location means, -1 if it means a cable: by its name, or as what is nearest of all.
int find_net(const RequestedPlace& place, const World& world, const FindFrame& find_frame) {
  if (!place.cable.empty() || place.mode != RequestedPlace::nearest) return find(world.nets(), place.cable);
  std::vector<std::string> errors;
  const std::optional<Vector3> point = read_point(place, find_frame, errors);
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
Location locate_net_node(const RequestedPlace& place, const World& world, int index, const FindFrame& find_frame) {
  const SimulatedNet& net = world.nets()[index];
  Location found;
  found.body = net_id(index);
  if (place.mode == RequestedPlace::at_node) {
    const bool exists = place.node >= 0 && place.node < net.model.nodes();
    if (exists)
      found.node = static_cast<int>(place.node);
    else
      found.errors.push_back(place.words->node + ": " + std::to_string(place.node) + "; allowed: 0 to " +
                             std::to_string(net.model.nodes() - 1));
  } else if (place.mode == RequestedPlace::nearest) {
    const std::optional<Vector3> point = read_point(place, find_frame, found.errors);
    if (point) {
      found.node = nearest_node(net, *point);
      found.distance = distance(net, *point);
    }
  } else {
    found.errors.push_back(mode_text(place) + " for net " + in_quotes(net.model.name) +
                           "; allowed: " + place.words->mode_names[RequestedPlace::at_node] + ", " +
                           place.words->mode_names[RequestedPlace::nearest]);
  }
  return found;
}

Location locate_links(const RequestedPlace& place, const World& world, int index, const FindFrame& find_frame) {
  const SimulatedNet& net = world.nets()[index];
  Location found = locate_net_node(place, world, index, find_frame);
  if (!found.errors.empty()) return found;
  if (place.mode == RequestedPlace::nearest) {
    const NearestPoint nearest = nearest_link(net, *read_point(place, find_frame, found.errors));
    if (nearest.segment >= 0) {
      found.elements.push_back(nearest.segment);
      found.node = net.model.links[nearest.segment][nearest.fraction > 0.5 ? 1 : 0];
    }
    found.distance = nearest.distance;
  } else {
    for (int link = 0; link < static_cast<int>(net.model.links.size()); ++link)
      if (net.model.links[link][0] == found.node || net.model.links[link][1] == found.node) found.elements.push_back(link);
  }
  if (found.elements.empty())
    found.errors.push_back(place_text(place) + ": net " + in_quotes(net.model.name) +
                           " has no link there; allowed: nodes that links join");
  return found;
}

/// The origin of a body's frame.
Location locate_body(const RequestedPlace& place, const World& world, int index) {
  Location found;
  found.body = rigid_body_id(index);
  if (!world.frame_known(world.bodies()[index].frame))
    found.errors.push_back(waits_for_frames(place.words->cable, place.cable, *place.words, "bodies"));
  else if (place.mode != RequestedPlace::at_node)
    found.errors.push_back(mode_text(place) + " for body " + in_quotes(place.cable) +
                           "; allowed: " + place.words->mode_names[RequestedPlace::at_node]);
  else if (place.node != 0)
    found.errors.push_back(place.words->node + ": " + std::to_string(place.node) +
                           "; allowed: 0, the origin of the body's frame");
  return found;
}

}  // namespace

const RequestWords& service_words() {
  static const RequestWords words{"location.cable",
                                  "location.node",
                                  "location.arc_length",
                                  "location.point",
                                  "location.point.point",
                                  "location.point.header.frame_id",
                                  "location.mode",
                                  {"0 (NODE)", "1 (ARC_LENGTH)", "2 (NEAREST)"},
                                  "location",
                                  "tf frames"};
  return words;
}

std::string place_text(const RequestedPlace& place) {
  return place.words->place.empty() ? place.words->mode_names.at(static_cast<std::size_t>(place.mode)) : place.words->place;
}

Location locate_node(const RequestedPlace& place, const World& world, const FindFrame& find_frame) {
  if (const int net = find_net(place, world, find_frame); net >= 0) return locate_net_node(place, world, net, find_frame);
  if (const int body = find(world.bodies(), place.cable); body >= 0) return locate_body(place, world, body);
  const PointOnCable found = find_point(place, world, find_frame, true);
  return {cable_id(found.cable), found.segment + (found.fraction > 0.5 ? 1 : 0), {}, found.distance, found.errors};
}

Location locate_cut(const RequestedPlace& place, const World& world, const FindFrame& find_frame) {
  if (const int net = find_net(place, world, find_frame); net >= 0) return locate_links(place, world, net, find_frame);
  PointOnCable found = find_point(place, world, find_frame, false);
  if (found.errors.empty()) {
    const SimulatedCable& cable = world.cables()[found.cable];
    const int last = cable.state.segments() - 2;
    const bool behind_the_end = place.mode == RequestedPlace::at_node && found.fraction > 0;
    if (last < 1) {
      found.errors.push_back(place.words->cable + ": " + in_quotes(cable.model->name) + " of " +
                             std::to_string(cable.state.segments()) +
                             " segments; allowed: cables of at least 3, so that each piece keeps one");
    } else if (found.segment < 1 || found.segment > last || behind_the_end) {
      found.errors.push_back(
          found.field + " means " + (behind_the_end ? "no segment" : "segment " + std::to_string(found.segment)) + " of cable " +
          in_quotes(cable.model->name) + "; allowed: segments 1 to " + std::to_string(last) + ", so that each piece keeps one");
    }
  }
  return {cable_id(found.cable), found.segment, {found.segment}, found.distance, found.errors};
}

}  // namespace verlet_cable

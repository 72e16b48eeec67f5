#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// Where a frame is in the fixed frame; none if it is not known.
using FindFrame = std::function<std::optional<Pose>(const std::string&)>;

/// How messages name what requests give.
struct RequestWords {
  std::string cable, node, arc_length, point, point_numbers, point_frame;
  std::string mode;                       ///< where it has a number; empty: it follows from what is given
  std::array<std::string, 3> mode_names;  ///< of at_node, at_arc_length, nearest
  std::string place;                      ///< all of it; empty: what is given of it
  std::string frames;                     ///< for which cables wait
  std::string is_true = ": true";         ///< how an argument is given as true
};

/// As CableLocation.msg and the node have it.
const RequestWords& service_words();

/// A place as requests give it. Nothing of it is checked.
struct RequestedPlace {
  static constexpr int at_node = 0, at_arc_length = 1, nearest = 2;
  std::string cable;                ///< or net, or rigid body; empty: what is nearest of all
  int mode = at_node;               ///< one of these
  std::int64_t node = 0;            ///< of at_node
  double arc_length = 0;            ///< [m] of at_arc_length: from the cable's start, at rest
  Vector3 point = Vector3::Zero();  ///< [m] of nearest
  std::string point_frame;          ///< in which the point is; empty: the fixed frame
  const RequestWords* words = &service_words();
};

/// What messages call a place, of a mode that there is.
std::string place_text(const RequestedPlace& place);

/// A place on a cable or net, or a body of a world, or everything that is wrong with the request for it.
struct Location {
  BodyId body;                ///< the cable, net or rigid body
  int node = 0;               ///< that was asked for; nearest: of a link that is cut, its nearer one
  std::vector<int> elements;  ///< to be cut: a segment, or links of a net; ascending
  double distance = 0;        ///< [m] nearest: from the given point
  std::vector<std::string> errors;
};

/// The node that is meant: the given one, or the one nearest to the arc length or to the point. Of a rigid body its frame's
/// origin, node 0.
Location locate_node(const RequestedPlace& place, const World& world, const FindFrame& find_frame);

/// The segment that is meant: the one that starts at the node, or contains the arc length or the point of the cable that is
/// nearest to the given one. Only segments that a cut can remove: each piece keeps at least one. Of a net the links at the node,
/// or the link that is nearest to the point.
Location locate_cut(const RequestedPlace& place, const World& world, const FindFrame& find_frame);

}  // namespace verlet_cable

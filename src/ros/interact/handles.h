#pragma once

#include <visualization_msgs/InteractiveMarker.h>

#include <set>
#include <string>
#include <vector>

#include "publish/drawing_frame.h"
#include "simulation/simulation.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// What can be taken with the mouse: an attachment, a node that nothing holds, or the origin of a body that is free to turn about
/// it.
struct Handle {
  std::string name;        ///< of the interactive marker: attachment/NAME or CABLE/NODE
  std::string attachment;  ///< empty: a node
  std::string cable;       ///< or body; empty: what holds a net or body
  int node = 0;
  bool is_body = false;   ///< a body's origin, which cannot be cut
  bool turns = false;     ///< a clamp or axle, whose orientation matters
  double radius = 0;      ///< [m] of the cable, or as if
  double half_width = 0;  ///< [m] from a node: where the mouse finds it
  double arm_length = 0;  ///< [m] of the arrows of an attachment
  Pose pose;              ///< in the fixed frame
};

bool look_alike(const Handle& a, const Handle& b);  ///< but for their poses

/// Entries of the menus.
enum class HandleAction : std::uint32_t { pin = 1, release, cut, reset };

/// Every attachment, the origins of bodies, and nodes evenly along the cables, not of nets: all of them in small scenes. `grabs`
/// are the attachments that stand for the mouse: their nodes count as held by nothing. What is not finite is left out.
std::vector<Handle> find_handles(const Simulation& simulation, const std::set<std::string>& grabs);

visualization_msgs::InteractiveMarker interactive_marker(const Handle& handle, const DrawingFrame& frame);

}  // namespace verlet_cable

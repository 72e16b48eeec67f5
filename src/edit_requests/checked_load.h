#pragma once

#include <optional>
#include <string>
#include <vector>

#include "edit_requests/location.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// How messages name what requests for loads give.
struct LoadWords {
  std::string on;  ///< what it acts on
  std::string force, torque;
  std::string axes;  ///< in which frame they are
};

/// As ApplyWrench.srv has it.
const LoadWords& service_load_words();

/// What is to act on a place, as requests give it. Nothing of it is checked.
struct RequestedLoad {
  std::string name;  ///< empty: that of the place, see `load_name`
  std::string
      frame_id;  ///< whose axes they are given in; empty: the fixed frame's; a body's own name: its own, with which they turn
  std::optional<Vector3> point;     ///< [m] of a rigid body: where, from its frame's origin in its axes; none: its center of mass
  Vector3 force = Vector3::Zero();  ///< [N]
  Vector3 torque = Vector3::Zero();  ///< [N m] of a rigid body
  double duration = 0;               ///< [s] 0: until it is changed
  const LoadWords* words = &service_load_words();
};

/// A request to apply a load in terms of the world, or everything that is wrong with it.
struct CheckedLoad {
  edit::ApplyLoad load;
  std::vector<std::string> errors;
};

/// `place`: as `locate_node` has found it; its errors are taken over.
CheckedLoad check_load(const RequestedLoad& request, const Location& place, const World& world, const FindFrame& find_frame);

/// Of a load that has no name of its own: the body's name, or that of a node, such as hose[3].
std::string load_name(const World& world, const BodyId& body, int node);

/// Of one that was checked.
EditResult apply_load(World& world, const edit::ApplyLoad& load);

}  // namespace verlet_cable

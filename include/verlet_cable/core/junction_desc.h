#pragma once

#include <string>
#include <vector>

#include "verlet_cable/core/attachment_desc.h"
#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// An end of a cable that is welded to a node of another one.
struct BranchDesc {
  enum class End { start, end };
  std::string cable;
  End end = End::start;
  /// Roll, pitch, yaw [rad] in the material's axes of the trunk cable at the junction. A branch without an initial shape of its
  /// own starts in the direction of the trunk, rotated by this.
  Vector3 rotation = Vector3::Zero();
};

/// A point where cables branch; light and without size.
struct JunctionDesc {
  /// rigid: keeps the initial angles between the cables, including roll; hinge: joins them at a point only
  enum class Type { rigid, hinge };
  std::string name;
  std::string cable;  ///< the trunk, from which the branches leave
  PlaceDesc place;    ///< on that cable
  std::vector<BranchDesc> branches;
  Type type = Type::rigid;
  double mass = 0;  ///< [kg], >= 0; added to the node's mass
};

}  // namespace verlet_cable

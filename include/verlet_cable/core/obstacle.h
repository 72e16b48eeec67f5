#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "verlet_cable/core/shape.h"

namespace verlet_cable {

/// A solid that cables cannot enter. It follows a frame.
struct Obstacle {
  std::string name;
  int frame = 0;  ///< index into World::frames()
  Pose pose;      ///< of the shape, in the frame
  Shape shape;
  std::optional<double> friction;  ///< Coulomb coefficient; none: that of the cable's material
  double padding = 0;              ///< [m] the surface lies that far outside of the shape's
  /// Ids of the frames that are rigidly joined to it. It does not push the first few centimetres of a cable around an attachment
  /// to one of these. Ascending; empty for an obstacle at rest in the fixed frame.
  std::vector<int> holders;
  bool present = false;  ///< its frame has been seen; there is nothing to bump into until then
  std::uint32_t id = 0;  ///< what touches the obstacle remembers it by that
};

}  // namespace verlet_cable

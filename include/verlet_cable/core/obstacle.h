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
  std::optional<double> friction;  ///< Coulomb coefficient; none: that of the material of the cable
  double padding = 0;              ///< [m] by which the surface is outside of that of the shape
  /// Ids of the frames that are rigidly joined to it. It does not touch the first few centimetres of a cable next to an
  /// attachment to one of these. Ascending; empty for an obstacle at rest in the fixed frame.
  std::vector<int> holders;
  bool present = false;  ///< whether its frame has been seen; until then it does not exist
  std::uint32_t id = 0;  ///< by which contacts remember it
};

}  // namespace verlet_cable

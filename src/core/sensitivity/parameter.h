#pragma once

namespace verlet_cable {

/// One number on which a world depends: a column of its derivatives.
struct SensitivityColumn {
  enum class Kind {
    axial_stiffness,
    axial_damping,
    bending_stiffness,
    bending_damping,
    drag,
    linear_density,
    length,
    translation,  ///< of a frame, along an axis of the fixed frame
    rotation,     ///< of a frame about its origin, about such an axis
    gravity       ///< its component along such an axis
  };
  Kind kind = Kind::drag;
  int cable = -1;  ///< index into World::cables(); of gravity and frames none
  int frame = -1;  ///< index into World::frames()
  int axis = 0;    ///< 0 to 2
};

}  // namespace verlet_cable

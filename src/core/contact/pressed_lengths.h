#pragma once

#include <vector>

#include "contact/law.h"
#include "verlet_cable/core/cable_materials.h"
#include "verlet_cable/core/shape.h"

namespace verlet_cable {

/// Whether a material asks for the lengths that contacts press on.
inline bool has_section(const MaterialDesc& material) {
  return material.transverse_stiffness < infinity || material.maximum_squeeze < infinity;
}

/// What a solid presses on of one segment, and the touches there, by their indices; -1: none.
struct PressedPart {
  int segment = 0;
  double from = 0, to = 0;  ///< fractions of the segment
  double flat = 0;          ///< how much of it the places where the face begins and ends bear, the deepest place bears the rest
  double first = 0, second = 0;  ///< [m] of its nodes from the surface
  bool is_straight = false;      ///< the surface has edges: it is pressed alike up to where a face ends, and not beside it
  bool is_over_face = false;     ///< all of it is, or part of it
  double deepest_fraction = 0;
  int begins = -1, deepest = -1, ends = -1;
};

/// The part of a segment, from `start` to `end` [m] in the shape's frame, that is less than `reach` [m] outside of a convex
/// solid: on both sides of a place that is, by its fraction; nothing on neither side where that is not.
PressedPart part_within(const Shape& shape, const Vector3& start, const Vector3& end, double fraction, double reach);

/// Which lengths of a cable touches stand for: each part is shared by the trapezoidal rule among the places in it where the cable
/// touches, so that all of them together bear on what is pressed, wherever nodes are, and a place that passes a node passes on
/// its length. Sets the lengths, and of soft sections what they have for them; touches that press on nothing of these are taken
/// out. `nodes`: the touch of each node, or -1; `feet`: one a touch from `first` on.
void set_pressed_lengths(const CableMaterials& materials, const CableState& state, const std::vector<PressedPart>& parts,
                         const std::vector<int>& nodes, std::size_t first, std::vector<Vector3>& feet,
                         std::vector<Touch>& touches);

/// [N/m] Of half the section on each [m] of a cable, for its touching side.
inline double side_stiffness(const MaterialDesc& material) {
  return 2 * material.transverse_stiffness;
}

/// Sets those of a touch of two segments, from one of which to the other `way` points: a cable covers of another one that crosses
/// it what is under its diameter, of one beside it what is beside its segment.
void set_crossed_lengths(const MaterialDesc& material, const Vector3& from, const Vector3& way,
                         const MaterialDesc& other_material, const Vector3& other_from, const Vector3& other_way, Touch& touch);

}  // namespace verlet_cable

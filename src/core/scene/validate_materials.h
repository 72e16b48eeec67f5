#pragma once

#include <string>

#include "scene/scene_errors.h"
#include "verlet_cable/core/cable.h"

namespace verlet_cable {

/// Numbers, names and bending stiffnesses of the scene's materials.
void check_materials(const SceneDesc& scene, Errors& errors);

/// Lines for dampings that leave nothing of a cable's motion. Steps are implicit and carry any damping; but where it outweighs
/// the inertia of a segment so much, rounding does, too.
void check_damping(const std::string& key, const SceneDesc& scene, const CableDesc& cable, const MaterialDesc& material,
                   Errors& errors);

/// A line where a cable's rest shape needs a torsional stiffness that its material does not have: where bending depends on how the
/// material is turned about the cable, something must resist its turning.
void check_torsional_stiffness(const std::string& key, const CableDesc& cable, const MaterialDesc& material, Errors& errors);

/// The same for a cable that may have got its rest shape from another one, by being joined with it.
void check_torsional_stiffness(const SimulatedCable& cable, const MaterialDesc& material, Errors& errors);

}  // namespace verlet_cable

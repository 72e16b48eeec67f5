#pragma once

#include <string>

#include "scene/scene_errors.h"
#include "verlet_cable/core/cable.h"

namespace verlet_cable {

/// Numbers, names and bending stiffnesses of the scene's materials.
void check_materials(const SceneDesc& scene, Errors& errors);

/// Lines for dampings that leave nothing of a cable's motion. Steps are implicit and carry any damping; but where it outweighs
/// the inertia of a segment so much, rounding does, too.
void check_damping(const std::string& key, const SceneDesc& scene, const CableDesc& cable, const NamedMaterial& named,
                   Errors& errors);

/// The materials of a cable and its sections that the scene has, each once.
std::vector<NamedMaterial> materials_of(const SceneDesc& scene, const CableDesc& cable);

/// A line where a cable needs a torsional stiffness that one of its materials does not have: where bending depends on how the
/// material is turned about the cable, by its rest shape or by what one of them is, something must resist its turning.
void check_torsional_stiffness(const std::string& key, const SceneDesc& scene, const CableDesc& cable, Errors& errors);

/// The same for a cable that may have got its rest shape from another one, by being joined with it, and with materials as in
/// `scene`.
void check_torsional_stiffness(const SimulatedCable& cable, const SceneDesc& scene, Errors& errors);

}  // namespace verlet_cable

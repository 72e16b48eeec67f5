#pragma once

#include "verlet_cable/core/scene_desc.h"

namespace verlet_cable {

/// What a segment is made of, in a scene that has all materials.
const MaterialDesc& material_at(const SceneDesc& scene, const CableDesc& cable, int segment);

/// Whether the cable resists bending on a side of a node.
bool bends_at(const SceneDesc& scene, const CableDesc& cable, int node);

}  // namespace verlet_cable

#include "scene/scene_materials.h"

#include <algorithm>

namespace verlet_cable {

const MaterialDesc& material_at(const SceneDesc& scene, const CableDesc& cable, int segment) {
  const int section = section_at(cable, segment);
  return *scene.find_material(section < 0 ? cable.material : cable.sections[section].material);
}

bool bends_at(const SceneDesc& scene, const CableDesc& cable, int node) {
  const auto bends = [&](int segment) { return material_at(scene, cable, segment).bending_stiffness.largest() > 0; };
  return bends(std::max(node - 1, 0)) || bends(std::min(node, cable.segments - 1));
}

}  // namespace verlet_cable

#include "material_presets.h"

#include "material_keys.h"
#include "material_presets_text.h"

namespace verlet_cable {
namespace {

std::vector<NamedMaterial> read_presets() {
  ErrorList errors;
  std::vector<NamedMaterial> presets = read_materials({YAML::Load(material_presets_text), "materials.yaml", &errors});
  if (!errors.empty()) throw SceneError(errors.take());
  return presets;
}

}  // namespace

const std::vector<NamedMaterial>& material_presets() {
  static const std::vector<NamedMaterial> presets = read_presets();
  return presets;
}

}  // namespace verlet_cable

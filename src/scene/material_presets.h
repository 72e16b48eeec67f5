#pragma once

#include <vector>

#include "verlet_cable/core/scene_desc.h"

namespace verlet_cable {

/// The materials of config/materials.yaml, as they were when the library was built: no file is looked for at run time.
const std::vector<NamedMaterial>& material_presets();

}  // namespace verlet_cable

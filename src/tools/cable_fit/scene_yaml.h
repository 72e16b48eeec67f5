#pragma once

#include <string>

#include "verlet_cable/core/scene_desc.h"

namespace verlet_cable::cable_fit {

/// Parts of the text of a scene.
std::string vector_text(const Vector3& v);
std::string materials_yaml(const SceneDesc& scene);
/// An element of `cables`: name, length, segments and material.
std::string plain_cable_yaml(const CableDesc& cable);
/// The same with what is stiff and bent, without its attachments.
std::string cable_yaml(const CableDesc& cable);

}  // namespace verlet_cable::cable_fit

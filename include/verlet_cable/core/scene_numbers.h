#pragma once

#include <string>

#include "verlet_cable/core/scene_desc.h"

namespace verlet_cable {

/// What a world reads of its scene when it begins and while it goes on, as bytes; what is made into bodies, guides, particles and
/// obstacles when it begins is not among it.
std::string numbers_of(const SceneDesc& scene);

/// Gives a scene with the same cables and nets the numbers of another. Throws std::invalid_argument with what is wrong with the
/// bytes; the scene is then of no use.
void set_numbers(const std::string& bytes, SceneDesc& scene);

}  // namespace verlet_cable

#pragma once

#include <memory>
#include <string>

#include "verlet_cable/core/scene_desc.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// A world as it is written to bytes, by Python and by the node.
struct WorldFile {
  std::shared_ptr<const SceneDesc> scene_at_first;  ///< with the numbers that it had before all tuning
  World world;
  std::string frames;  ///< what moves its frames; empty: they rest where they are
};

/// Bytes that say what they are, of which version, and of what kind of scene, and end with a checksum.
std::string write_world(const SceneDesc& scene_at_first, const World& world, const std::string& frames);

/// The parts of such bytes with what goes before and after them: what they are, and their checksum.
std::string sealed(const std::string& parts);

/// `scene`: like that of which the world was, but for numbers. Throws std::invalid_argument: "data: " and what is wrong with the
/// bytes.
WorldFile read_world(const SceneDesc& scene, const std::string& data);

}  // namespace verlet_cable

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// Of every scene in config/, fuzz/worlds and test/soak: its path in the package without ".yaml", with _ for what is no letter
/// and no digit.
std::vector<std::string> shipped_scene_names();
std::string shipped_scene_path(const std::string& name);

/// CSV text that moves the frames of a shipped scene for a time [s]: the file beside it; where there is none, each frame sways
/// and turns by itself about where the scene has it. Empty where no frame is there.
std::string motion_of_shipped_scene(const std::string& path, const SceneDesc& scene, double duration);

/// A run of a scene: where its frames are, and what comes of it.
struct ShippedRun {
  SceneDesc scene;
  World start;
  std::vector<BoundaryInputs> frames;  ///< at the start, then at the end of each step
  std::vector<std::uint64_t> bytes;    ///< of the world, see `bytes_of`, likewise
};

/// Runs a shipped scene once, with the motion in the file at `motion` (empty: none).
ShippedRun run_shipped_scene(const std::string& path, const std::string& motion, int steps);

/// Changes with each byte that a world keeps for its next steps, and that it shows of the last one.
std::uint64_t bytes_of(const World& world, const StepResult& result = {});

}  // namespace verlet_cable

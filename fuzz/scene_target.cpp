// Scenes: text through twenty steps.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>

#include "check_world.h"
#include "verlet_cable/scene/scene_reader.h"

namespace {

using namespace verlet_cable;

constexpr int steps = 20;
/// Larger scenes are read, but not simulated: that is slow, and no other code.
constexpr int most_segments = 60;

bool is_small(const SceneDesc& scene) {
  std::size_t elements = scene.particles.size() + scene.bodies.size() + scene.obstacles.size();
  for (const CableDesc& cable : scene.cables) elements += static_cast<std::size_t>(cable.segments);
  for (const NetDesc& net : scene.nets) elements += net.link_count();
  return elements <= most_segments;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // No file that the text names is opened.
  SceneSources nothing_else;
  nothing_else.files.anywhere = false;
  try {
    const SceneDesc scene = read_scene_text(std::string(reinterpret_cast<const char*>(data), size), nothing_else);
    if (!is_small(scene)) return 0;
    BoundaryInputs frames = initial_frames(scene);
    for (FrameInput& frame : frames) frame.known = true;
    World world(scene, frames);
    fuzz::check_world(world);
    frames.resize(world.frames().size());
    for (int i = 0; i < steps; ++i) world.step(frames);
    fuzz::check_world(world);
  } catch (const SceneError&) {
    // Refused, with its errors.
  }
  return 0;
}

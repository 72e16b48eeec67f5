#include "scene_sources/scene_outline.h"

#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/quoted_text.h"

namespace verlet_cable {

std::string scene_outline(const SceneDesc& scene) {
  std::string outline;
  const auto add = [&](std::size_t count, const char* one, const char* many) {
    if (count > 0) outline += std::to_string(count) + " " + (count == 1 ? one : many) + ", ";
  };
  std::size_t segments = 0;
  for (const CableDesc& cable : scene.cables) segments += static_cast<std::size_t>(cable.segments);
  add(scene.cables.size(), "cable", "cables");
  add(segments, "segment", "segments");
  add(scene.nets.size(), "net", "nets");
  add(scene.particles.size(), "particle", "particles");
  add(scene.bodies.size(), "body", "bodies");
  add(all_obstacles(scene).size(), "obstacle", "obstacles");
  return outline + "fixed frame " + in_quotes(scene.frame_id) + ", time step " + rounded_text(1e3 * scene.time_step) + " ms";
}

}  // namespace verlet_cable

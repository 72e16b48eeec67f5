#pragma once

#include <algorithm>

#include "verlet_cable/core/scene_desc.h"

namespace verlet_cable {

/// What counts towards `limits.segments` beside the segments of cables: nodes or links of nets, whichever are more, particles and
/// bodies.
inline double size_beside_cables(const SceneDesc& scene) {
  double size = static_cast<double>(scene.particles.size() + scene.bodies.size());
  for (const NetDesc& net : scene.nets) size += static_cast<double>(std::max(net.node_count(), net.link_count()));
  return size;
}

}  // namespace verlet_cable

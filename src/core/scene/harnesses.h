#pragma once

#include <string>
#include <vector>

#include "verlet_cable/core/scene_desc.h"

namespace verlet_cable {

/// Where a cable takes part in a junction: as its trunk, or with an end.
struct JunctionPlace {
  int junction = 0;                    ///< index into the scene's junctions
  int node = 0;                        ///< of the cable
  const BranchDesc* branch = nullptr;  ///< none: it is the trunk
};
std::vector<JunctionPlace> junction_places(const SceneDesc& scene, const CableDesc& cable);

/// Whether a rigid junction holds the cable.
bool is_welded(const SceneDesc& scene, const std::string& cable);

/// Whether an attachment or a guide of a cable is on the body.
bool hangs_on(const SceneDesc& scene, const BodyDesc& body, const CableDesc& cable);

/// For each cable of the scene the first one that junctions or bodies join it to, directly or by others; itself if there is none.
std::vector<int> harnesses_of(const SceneDesc& scene);

}  // namespace verlet_cable

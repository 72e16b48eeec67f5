#pragma once

#include <string>
#include <vector>

#include "target/boundary.h"
#include "verlet_cable/core/cable.h"
#include "verlet_cable/core/scene_desc.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// Of the material around a node, from the motion of the nodes next to it [rad/s].
Vector3 spin_at(const CableState& state, int node);

/// Lays loops where one junction holds two nodes of a cable and its shape leaves them apart, or where one that was not given and
/// that bends would be folded; then carries it to what holds it (`held`, without junctions). False if there were any.
bool close_loops(const std::vector<Attachment>& attachments, BodyId body, bool is_given, const std::vector<HeldNode>& held,
                 const Vector3& gravity, SimulatedCable& cable);

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

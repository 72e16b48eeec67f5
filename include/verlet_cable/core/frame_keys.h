#pragma once

#include <string>
#include <vector>

#include "verlet_cable/core/scene_desc.h"

namespace verlet_cable {

/// The keys by which a scene names a frame of tf, as errors write them: `cables[0].attachments[1].frame`. `frame_id`, the links
/// of its robot, and the names of bodies that are frames (broadcast_tf) count, too.
std::vector<std::string> keys_of_frame(const SceneDesc& scene, const std::string& frame);

}  // namespace verlet_cable

#pragma once

#include <string>
#include <vector>

#include "verlet_cable/core/scene_desc.h"

namespace verlet_cable {

/// The links of a URDF, parents first, those that `robot` selects with the geometry that it selects, and its padding. Meshes have
/// their URIs, but are not read. A link's first obstacle has its name, the others have `_1`, `_2`, ... behind it, without those
/// that are the names of other links. Throws ResourceError where the text is no URDF.
std::vector<LinkDesc> read_urdf(const std::string& text, const RobotDesc& robot);

}  // namespace verlet_cable

#pragma once

#include <visualization_msgs/Marker.h>

#include <vector>

#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// What shows a guide, without header and ids: an eyelet is a ring about the cable, a clip a ring with a gap, which is wide while
/// it is open, a sheave a wheel with two rims.
std::vector<visualization_msgs::Marker> guide_markers(const World& world, int guide);

}  // namespace verlet_cable

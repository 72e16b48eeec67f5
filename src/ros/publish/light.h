#pragma once

#include <std_msgs/ColorRGBA.h>

#include "verlet_cable/core/types.h"

namespace verlet_cable {

// rviz draws triangles that have colors of their own without light, so that nothing would look round: their colors bring it
// along.

/// A color on the outside of something closed, where its surface has this unit normal.
std_msgs::ColorRGBA lit(const std_msgs::ColorRGBA& color, const Vector3& normal);

/// A color on a sheet that is seen from both sides.
std_msgs::ColorRGBA lit_from_both_sides(const std_msgs::ColorRGBA& color, const Vector3& normal);

}  // namespace verlet_cable

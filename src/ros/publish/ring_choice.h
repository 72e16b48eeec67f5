#pragma once

#include <std_msgs/ColorRGBA.h>

#include <vector>

#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// The nodes at which a tube along `centers` has its rings, ascending, the first and the last among them: straight lines from
/// one to the next pass all other nodes within `tolerance` [m], closer in sharp bends, and mix their colors to a fortieth of a
/// channel. A stretch is always divided at the same nodes, in halves or, where that is enough, in thirds, so that rings do not
/// wander along a cable that moves. Empty if it takes more than `most` (2 at least).
std::vector<int> choose_rings(const std::vector<Vector3>& centers, const std::vector<std_msgs::ColorRGBA>& colors,
                              double tolerance, int most);

/// Places for `count` rings (2 at least), the first node being 0 and the middle between it and the next 0.5: denser where the
/// cable bends more, so that straight lines between them are about equally far off everywhere. They move smoothly with the cable.
std::vector<double> spread_rings(const std::vector<Vector3>& centers, int count);

}  // namespace verlet_cable

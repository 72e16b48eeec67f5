#pragma once

#include <functional>

namespace verlet_cable::cable_fit {

/// Calls `work` once for every index from 0 to `count`, on all cores; which core does which depends on chance, so results belong
/// into places of their own. The first exception by index is thrown.
void for_each_index(int count, const std::function<void(int)>& work);

}  // namespace verlet_cable::cable_fit

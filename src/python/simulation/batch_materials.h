#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "simulation/driven_world.h"

namespace verlet_cable {

/// Lines of an exception about the worlds of a batch: after so many no further world is looked at.
constexpr std::size_t most_errors = 100;

/// A number of a material, for each world.
struct MaterialChange {
  std::string field;                     ///< a key of materials
  std::vector<BendingStiffness> values;  ///< one a world; but for bending_stiffness both numbers are the same
};

/// The scenes of some worlds with a material changed. Throws SceneError with all that is wrong with them, also where a world that
/// is no longer as it began is given a linear_density, which tuning does not take over; and UnknownName.
std::vector<std::shared_ptr<const SceneDesc>> scenes_with(const std::string& material, const std::vector<MaterialChange>& changes,
                                                          const std::vector<DrivenWorld>& worlds);

}  // namespace verlet_cable

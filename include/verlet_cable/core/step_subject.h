#pragma once

#include <string>

#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// The name of the cable, net or particle that a step's status is about; empty where all is well.
inline std::string subject_of(const World& world, const StepResult& result) {
  if (result.cable >= 0) return world.cables()[static_cast<std::size_t>(result.cable)].model.name;
  if (result.net >= 0) return world.nets()[static_cast<std::size_t>(result.net)].model.name;
  return result.particle >= 0 ? world.particles()[static_cast<std::size_t>(result.particle)].desc.name : "";
}

}  // namespace verlet_cable

#pragma once

#include <string>

#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// The name of a body; empty where there is none.
inline std::string name_of(const World& world, const BodyId& body) {
  const auto index = static_cast<std::size_t>(body.index);
  switch (body.kind) {
    case BodyId::Kind::cable:
      return world.cables()[index].model->name;
    case BodyId::Kind::net:
      return world.nets()[index].model.name;
    case BodyId::Kind::particle:
      return world.particles()[index].desc.name;
    case BodyId::Kind::none:
      break;
  }
  return "";
}

}  // namespace verlet_cable

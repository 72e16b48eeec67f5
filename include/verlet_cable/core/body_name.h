#pragma once

#include <string>

#include "verlet_cable/core/quoted_text.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// The name of a body; empty if there is no body.
inline std::string name_of(const World& world, const BodyId& body) {
  const auto index = static_cast<std::size_t>(body.index);
  switch (body.kind) {
    case BodyId::Kind::cable:
      return world.cables()[index].model->name;
    case BodyId::Kind::net:
      return world.nets()[index].model.name;
    case BodyId::Kind::particle:
      return world.particles()[index].desc.name;
    case BodyId::Kind::rigid_body:
      return world.bodies()[index].name;
    case BodyId::Kind::none:
      break;
  }
  return "";
}

/// The kind and the name for messages, such as: cable "hose".
inline std::string kind_and_name(const World& world, const BodyId& body) {
  const char* kind = body.is_cable() ? "cable" : body.is_net() ? "net" : body.is_rigid_body() ? "body" : "particle";
  return std::string(kind) + " " + in_quotes(name_of(world, body));
}

}  // namespace verlet_cable

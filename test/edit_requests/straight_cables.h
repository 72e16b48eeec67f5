#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "edit_requests/location.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

struct StraightCable {
  std::string name;
  Vector3 start;
};

/// Cables of ten segments of 0.1 m that lie straight along +x; the first is held at its start, by `<name>_start`.
inline SceneDesc straight_cables(const std::vector<StraightCable>& cables) {
  SceneDesc scene;
  NamedMaterial& rope = scene.materials.emplace_back();
  rope.name = "rope";
  rope.material.linear_density = 0.1;
  rope.material.radius = 0.01;
  for (const StraightCable& straight : cables) {
    CableDesc& cable = scene.cables.emplace_back();
    cable.name = straight.name;
    cable.length = 1;
    cable.segments = 10;
    cable.material = rope.name;
    cable.initial.type = InitialShapeDesc::Type::straight;
    cable.initial.from = straight.start;
    cable.initial.to = straight.start + Vector3::UnitX();
  }
  AttachmentDesc& attachment = scene.cables.front().attachments.emplace_back();
  attachment.name = cables.front().name + "_start";
  attachment.offset = cables.front().start;
  return scene;
}

inline RequestedPlace at_node(const std::string& cable, std::int64_t node) {
  RequestedPlace place;
  place.cable = cable;
  place.node = node;
  return place;
}

}  // namespace verlet_cable

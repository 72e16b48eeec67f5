#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "bodies.h"
#include "validation.h"

/// Cables that branch.
namespace verlet_cable::validation {

/// A cable that begins along the straight line from `from` to `to`, as long as that is; nothing holds it.
inline CableDesc& add_straight(SceneDesc& scene, const std::string& name, int segments, const Vector3& from, const Vector3& to) {
  CableDesc& cable = scene.cables.emplace_back();
  cable.name = name;
  cable.length = (to - from).norm();
  cable.segments = segments;
  cable.material = "rope";
  cable.initial.type = InitialShapeDesc::Type::points;
  cable.initial.points = {from, to};
  return cable;
}

/// Roll, pitch, yaw that take x to a direction, without roll.
inline Vector3 towards(const Vector3& direction) {
  const Vector3 way = direction.normalized();
  return {0, -std::asin(way.z()), std::atan2(way.y(), way.x())};
}

inline AttachmentDesc& hold_end(CableDesc& cable, PlaceDesc::At at, const Vector3& offset, AttachmentType type,
                                const Vector3& rotation = Vector3::Zero()) {
  const std::string name = cable.name + (at == PlaceDesc::At::end ? "_end" : "_start");
  cable.attachments.push_back(scenes::attachment(name, at, offset, "", type));
  cable.attachments.back().rotation = rotation;
  return cable.attachments.back();
}

inline PlaceDesc at_arc_length(double arc_length) {
  PlaceDesc place;
  place.at = PlaceDesc::At::arc_length;
  place.arc_length = arc_length;
  return place;
}

inline JunctionDesc& add_junction(SceneDesc& scene, const std::string& trunk, const PlaceDesc& place,
                                  const std::vector<BranchDesc>& branches, JunctionDesc::Type type = JunctionDesc::Type::rigid) {
  JunctionDesc& junction = scene.junctions.emplace_back();
  junction.name = "knot" + std::to_string(scene.junctions.size());
  junction.cable = trunk;
  junction.place = place;
  junction.branches = branches;
  junction.type = type;
  return junction;
}

inline BranchDesc branch(const std::string& cable, BranchDesc::End end = BranchDesc::End::start) {
  BranchDesc desc;
  desc.cable = cable;
  desc.end = end;
  return desc;
}

inline const CableState& cable_of(const World& world, const std::string& name) {
  return world.cables()[find(world.cables(), name)].state;
}

}  // namespace verlet_cable::validation

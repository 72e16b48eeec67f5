#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "verlet_cable/core/world.h"

/// Scenes that tests and benchmarks share.
namespace verlet_cable::scenes {

/// One cable, "cable", of a light rope: 0.1 kg/m, 5 mm.
inline SceneDesc one_cable(int segments, double length = 1) {
  SceneDesc scene;
  MaterialDesc rope;
  rope.linear_density = 0.1;
  rope.radius = 0.005;
  scene.materials.push_back({"rope", rope});
  CableDesc cable;
  cable.name = "cable";
  cable.length = length;
  cable.segments = segments;
  cable.material = "rope";
  scene.cables.push_back(cable);
  return scene;
}

inline AttachmentDesc attachment(const std::string& name, PlaceDesc::At at, const Vector3& offset, const std::string& frame = "",
                                 AttachmentType type = AttachmentType::hinge) {
  AttachmentDesc desc;
  desc.name = name;
  desc.place.at = at;
  desc.offset = offset;
  desc.frame = frame;
  desc.type = type;
  return desc;
}

/// A payload [kg] at the end of a cable.
inline PointMassDesc payload(double mass) {
  PointMassDesc desc;
  desc.place.at = PlaceDesc::At::end;
  desc.mass = mass;
  return desc;
}

/// Hangs between two points on a level, `span` apart.
inline SceneDesc between_two_points(int segments, double span, double length = 1) {
  SceneDesc scene = one_cable(segments, length);
  scene.cables[0].attachments = {attachment("left", PlaceDesc::At::start, {0, 0, 0}),
                                 attachment("right", PlaceDesc::At::end, {span, 0, 0})};
  return scene;
}

/// Hangs on one end at the origin, straight, released from rest at an angle [rad] from the vertical.
inline SceneDesc released(int segments, double angle, double length = 1) {
  SceneDesc scene = one_cable(segments, length);
  scene.cables[0].attachments = {attachment("top", PlaceDesc::At::start, {0, 0, 0})};
  scene.cables[0].initial.type = InitialShapeDesc::Type::straight;
  scene.cables[0].initial.to = {std::sin(angle), 0, -std::cos(angle)};
  return scene;
}

/// Hangs between the origin and the frame "hand".
inline SceneDesc held_by_a_hand(int segments, AttachmentType type = AttachmentType::hinge) {
  SceneDesc scene = one_cable(segments);
  scene.cables[0].attachments = {attachment("base", PlaceDesc::At::start, {0, 0, 0}, "", type),
                                 attachment("grip", PlaceDesc::At::end, {0, 0, 0}, "hand", type)};
  return scene;
}

/// Inputs for `held_by_a_hand`: the hand at a place.
inline BoundaryInputs hand_at(const Vector3& position) {
  BoundaryInputs inputs(2);
  inputs[1].pose.position = position;
  return inputs;
}

}  // namespace verlet_cable::scenes

#pragma once

#include <cmath>
#include <string>

#include "scenes.h"

namespace verlet_cable::scenes {

/// A wire harness: a trunk of 0.6 m, clamped to the frames "left_hand" and "right_hand" at its ends, and branches with a plug
/// each, which leave it sideways, at nodes along it, from small bodies that the trunk runs through. All cables have as many
/// segments.
inline SceneDesc harness(int branches, int segments, const BendingStiffness& stiffness = {0.002, 0.002}) {
  constexpr double trunk_length = 0.6, branch_length = 0.3, joint_mass = 1e-4, joint_inertia = 1e-9;
  SceneDesc scene = one_cable(segments, trunk_length);
  MaterialDesc& wire = scene.materials[0].material;
  wire.linear_density = 0.05;
  wire.radius = 0.002;
  wire.bending_stiffness = stiffness;
  wire.torsional_stiffness = 0.0015;
  wire.bending_damping = wire.torsional_damping = 2e-5;
  const auto add_body = [&](const std::string& name, double mass, const Vector3& inertia) {
    BodyDesc& body = scene.bodies.emplace_back();
    body.name = name;
    body.mass = mass;
    body.inertia = inertia;
  };
  const auto clamp = [](const std::string& name, const PlaceDesc& place, const std::string& body, double yaw) {
    AttachmentDesc desc = attachment(name, place.at, Vector3::Zero(), "", AttachmentType::clamp);
    desc.place = place;
    desc.body = body;
    desc.rotation = {0, 0, yaw};
    return desc;
  };
  const auto at = [](PlaceDesc::At place, double distance = 0) {
    PlaceDesc desc;
    desc.at = place;
    desc.arc_length = distance;
    return desc;
  };
  scene.cables[0].name = "trunk";
  scene.cables[0].attachments = {attachment("left", PlaceDesc::At::start, Vector3::Zero(), "left_hand", AttachmentType::clamp),
                                 attachment("right", PlaceDesc::At::end, Vector3::Zero(), "right_hand", AttachmentType::clamp)};
  scene.cables[0].attachments[0].initial_pose = InitialPose{};
  scene.cables[0].attachments[1].initial_pose = InitialPose{0.9 * trunk_length, 0, 0, 0, 0, 0};
  for (int i = 0; i < branches; ++i) {
    const std::string number = std::to_string(i + 1);
    const double along = trunk_length / segments * ((i + 1) * segments / (branches + 1)), side = i % 2 == 0 ? 1 : -1;
    add_body("joint" + number, joint_mass, joint_inertia * Vector3::Ones());
    add_body("plug" + number, 0.01, 1e-6 * Vector3(1, 2, 2));
    scene.cables[0].attachments.push_back(clamp("through" + number, at(PlaceDesc::At::arc_length, along), "joint" + number, 0));
    CableDesc& branch = scene.cables.emplace_back();
    branch.name = "branch" + number;
    branch.length = branch_length;
    branch.segments = segments;
    branch.material = "rope";
    branch.attachments = {clamp("from" + number, at(PlaceDesc::At::start), "joint" + number, side * M_PI / 2),
                          clamp("plugged" + number, at(PlaceDesc::At::end), "plug" + number, 0)};
  }
  return scene;
}

}  // namespace verlet_cable::scenes

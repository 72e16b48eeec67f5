#pragma once

#include "verlet_cable/core/world.h"

namespace verlet_cable::scenes {

/// A scene whose frames are carried as far as the scene is.
inline BoundaryInputs translated(BoundaryInputs inputs, const Vector3& by) {
  for (std::size_t i = 1; i < inputs.size(); ++i) inputs[i].pose.position += by;
  return inputs;
}

/// The same scene elsewhere: all that is given in the fixed frame, and the frames' initial poses.
inline SceneDesc translated(SceneDesc scene, const Vector3& by) {
  const auto is_fixed = [&](const std::string& frame) { return frame.empty() || frame == scene.frame_id; };
  const auto carry = [&](InitialPose& pose) {
    for (int i = 0; i < 3; ++i) pose[i] += by[i];
  };
  for (CableDesc& cable : scene.cables) {
    cable.initial.from += by;
    cable.initial.to += by;
    for (Vector3& point : cable.initial.points) point += by;
    for (AttachmentDesc& attachment : cable.attachments) {
      if (is_fixed(attachment.frame)) attachment.offset += by;
      if (attachment.initial_pose) carry(*attachment.initial_pose);
    }
  }
  for (NetDesc& net : scene.nets) {
    if (net.grid) net.grid->origin += by;
    for (Vector3& node : net.nodes) node += by;
    for (NetAttachmentDesc& attachment : net.attachments) {
      if (is_fixed(attachment.frame)) attachment.offset += by;
      if (attachment.initial_pose) carry(*attachment.initial_pose);
    }
  }
  for (ParticleDesc& particle : scene.particles) particle.position += by;
  for (ObstacleDesc& obstacle : scene.obstacles) {
    if (is_fixed(obstacle.frame)) carry(obstacle.pose);
    if (obstacle.initial_pose) carry(*obstacle.initial_pose);
  }
  scene.gravity.center += by;
  scene.fluid.surface += by.z();
  return scene;
}

}  // namespace verlet_cable::scenes

#pragma once

#include "verlet_cable/core/obstacle.h"
#include "verlet_cable/core/scene_desc.h"

namespace verlet_cable {

/// What a scene describes, but for the frame, and what a world fills in. Of a mesh, the file must have been read.
inline Obstacle obstacle_of(const ObstacleDesc& desc) {
  Obstacle obstacle;
  obstacle.name = desc.name;
  obstacle.pose = pose_of(desc.pose);
  obstacle.shape = shape_of(desc);
  obstacle.friction = desc.friction;
  obstacle.padding = desc.padding;
  return obstacle;
}

}  // namespace verlet_cable

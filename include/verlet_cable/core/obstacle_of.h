#pragma once

#include "verlet_cable/core/obstacle.h"
#include "verlet_cable/core/scene_desc.h"

namespace verlet_cable {

/// The obstacle that a scene describes, without its frame and what a world fills in. The file of a mesh must have been read.
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

#pragma once

#include <vector>

#include "verlet_cable/core/obstacle.h"

namespace verlet_cable {

/// An obstacle during a substep.
struct MovingObstacle {
  const Obstacle* obstacle = nullptr;
  int index = 0;     ///< into World::obstacles()
  Pose start, end;   ///< of its shape
  Aabb box;          ///< around it at the start, in the fixed frame [m]
  double speed = 0;  ///< [m/s] no point of it is faster
};

/// The obstacles that are there, as they move over a part of a step, 0 to 1, between two poses of their frames.
void move_obstacles(const std::vector<Obstacle>& obstacles, const std::vector<Pose>& before, const std::vector<Pose>& after,
                    double time_step, double from, double to, std::vector<MovingObstacle>& moving);

}  // namespace verlet_cable

#pragma once

#include <vector>

#include "body/body_progress.h"
#include "contact/moving_obstacle.h"
#include "verlet_cable/core/body.h"

namespace verlet_cable {

/// How the points of a body move now: velocities, and accelerations as over the last substep.
PointMotion velocity_of(const SimulatedBody& body);
PointMotion acceleration_of(const SimulatedBody& body, const BodyProgress& progress);

/// The shapes of bodies, as what cables touch.
class BodySurfaces {
 public:
  void clear() { moving_.clear(); }
  /// Those of a body, whose index is given, where it is now, for a substep of h [s].
  void add(int index, const SimulatedBody& body, const BodyProgress& progress, double h);
  /// Valid until shapes are added.
  const std::vector<MovingObstacle>& all();

 private:
  std::vector<Obstacle> obstacles_;  ///< no fewer than there are
  std::vector<MovingObstacle> moving_;
};

/// [kg] With which a body resists along a direction at a point.
double mass_at(const SimulatedBody& body, const Vector3& point, const Vector3& direction);

}  // namespace verlet_cable

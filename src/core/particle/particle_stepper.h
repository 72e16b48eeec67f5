#pragma once

#include "contact/moving_obstacle.h"
#include "particle/integrator.h"
#include "verlet_cable/core/net.h"

namespace verlet_cable {

/// Advances free particles, one by one: gravity moves them, obstacles turn them back.
class ParticleStepper {
 public:
  ParticleStepper() { integrator_.resize(1); }
  /// False if the particle has run away; it is then as before.
  bool advance(const SceneDesc& scene, const std::vector<MovingObstacle>& obstacles, SimulatedParticle& particle,
               PointState& memory);

 private:
  PointIntegrator integrator_;
};

}  // namespace verlet_cable

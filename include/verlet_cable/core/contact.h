#pragma once

#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// A point where a cable touches something, and the force on the cable there, mean over the last substep.
struct SimulatedContact {
  int cable = 0;  ///< index into World::cables()
  int segment = 0;
  Vector3 position = Vector3::Zero();  ///< [m] on the cable's centre line
  Vector3 normal = Vector3::UnitZ();   ///< unit, away from what is touched
  Vector3 force = Vector3::Zero();     ///< [N] on the cable
  int obstacle = -1;                   ///< index into World::obstacles(), -1: none is touched
  int other_cable = -1;                ///< index into World::cables(), -1: none is touched
  int other_segment = -1;
  int body = -1;  ///< index into World::bodies(), -1: none is touched
};

}  // namespace verlet_cable

#pragma once

#include <vector>

#include "verlet_cable/core/scene_desc.h"
#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// What a linear wave is beside its description.
struct Wave {
  double frequency = 0;                 ///< [rad/s]
  double number = 0;                    ///< [rad/m]
  Vector3 direction = Vector3::Zero();  ///< in which it runs
  double amplitude = 0, phase = 0;      ///< [m], [rad]
};

/// The wave number [rad/m] of a linear wave of that frequency [rad/s] on water of that depth [m], which may be infinite: by the
/// dispersion relation frequency^2 = gravity number tanh(number depth) (Dean and Dalrymple, Water Wave Mechanics for Engineers
/// and Scientists, 1991), by Newton's method to rounding.
double wave_number(double frequency, double gravity, double depth);

/// Those of a scene, in their order. Their gravity is uniform.
std::vector<Wave> waves_of(const SceneDesc& scene);

/// Where the water is, and how it moves, at a point and a time.
struct WaterMotion {
  double surface = infinity;               ///< [m] z of its surface above or below the point
  Vector3 velocity = Vector3::Zero();      ///< [m/s] current and waves
  Vector3 acceleration = Vector3::Zero();  ///< [m/s^2] of the water that is there
};

/// The water, `time` [s] being the world's. Waves add; between crest and still water they move it as at still water (vertical
/// stretching, as in HydroDyn; Jonkman, Hayman and others, HydroDyn User's Guide and Theory Manual, NREL, 2014), below the bottom
/// as at the bottom.
WaterMotion water_at(const FluidDesc& fluid, const std::vector<Wave>& waves, const Vector3& point, double time);

}  // namespace verlet_cable

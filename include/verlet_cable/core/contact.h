#pragma once

#include <string>
#include <vector>

#include "verlet_cable/core/types.h"

namespace verlet_cable {

class World;

/// A point where a cable touches something, and the force on the cable there, mean over the last step. Or one where a body
/// touches an obstacle: `body` is then what the force is on.
struct SimulatedContact {
  int cable = -1;  ///< index into World::cables(), -1: a body touches
  int segment = 0;
  Vector3 position = Vector3::Zero();  ///< [m] on the cable's centre line, at the end of the step
  Vector3 normal = Vector3::UnitZ();   ///< unit, away from what is touched
  Vector3 force = Vector3::Zero();     ///< [N] on the cable
  int obstacle = -1;                   ///< index into World::obstacles(), -1: none is touched
  int other_cable = -1;                ///< index into World::cables(), -1: none is touched
  int other_segment = -1;
  int body = -1;                     ///< index into World::bodies(), -1: none touches or is touched
  Vector3 torque = Vector3::Zero();  ///< [N m] about the position: friction acts on the cable's surface where that turns
  double length = 0;                 ///< [m] of the cable that it presses on; 0 where the material has no transverse properties
  double other_length = 0;           ///< [m] likewise of the other cable
};

/// The contacts of the last step as each cable feels them: those of cables with cables appear twice.
std::vector<SimulatedContact> contacts_of_both(const World& world);

/// What the cables and bodies that touch a solid exert on it, mean over the last step, in the axes of the fixed frame.
struct ContactWrench {
  int frame = -1;                    ///< index into World::frames(): the solid's; -1: there is no such solid
  Vector3 force = Vector3::Zero();   ///< [N]
  Vector3 torque = Vector3::Zero();  ///< [N m] about the origin of the frame
};

/// Names of what can be touched: of the obstacles, links of a robot included, and of the bodies.
std::vector<std::string> solid_names(const World& world);

}  // namespace verlet_cable

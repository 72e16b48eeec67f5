#pragma once

#include <cstdint>
#include <string>

#include "verlet_cable/core/body_id.h"
#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// A force on a node of a cable, or a force and a torque on a rigid body, from outside. It acts in each step until it is changed,
/// or its time runs out, and follows its node through edits.
struct Load {
  std::string name;
  BodyId body;   ///< a cable or a rigid body
  int node = 0;  ///< of a cable
  Vector3 point =
      Vector3::Zero();  ///< [m] of a rigid body: where the force acts, in the axes of the body's frame, from its origin
  Vector3 force = Vector3::Zero();   ///< [N]
  Vector3 torque = Vector3::Zero();  ///< [N m] of a rigid body
  bool is_local = false;      ///< force and torque are given in the body's axes, with which they turn; else in the fixed frame's
  std::int64_t end_step = 0;  ///< World::steps() at which it ends; 0: it does not by itself
};

/// A load that has ended by itself.
struct EndedLoad {
  std::string name;
  std::string on;       ///< name of the cable or body
  bool ran_out = true;  ///< its time has; otherwise a winch has taken its node in
};

}  // namespace verlet_cable

#pragma once

#include <array>
#include <string>

#include "verlet_cable/core/guide_desc.h"
#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// What a cable slides through.
struct SimulatedGuide {
  std::string name;
  GuideDesc::Type type = GuideDesc::Type::eyelet;
  int frame = 0;          ///< index into World::frames(); it may be that of a rigid body
  Pose pose;              ///< in the frame
  int cable = -1;         ///< that is in it, index into World::cables(); -1: none
  double arc_length = 0;  ///< [m] of the material in it, from the cable's start, at rest; of a sheave at the middle of the arc
  std::array<double, 2> tension{0, 0};  ///< [N] of the cable before and behind it, mean over the last step
};

}  // namespace verlet_cable

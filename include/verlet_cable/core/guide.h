#pragma once

#include <array>
#include <string>

#include "verlet_cable/core/guide_desc.h"
#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// What a cable slides through. The attachment that names it holds a place of the cable there, through which material flows.
struct SimulatedGuide {
  std::string name;
  GuideDesc::Type type = GuideDesc::Type::eyelet;
  double friction = 0;           ///< Coulomb coefficient, may be infinite
  double radius = 0;             ///< [m] of a sheave, to the cable's center line
  double inertia = 0;            ///< [kg m^2] of a sheave's wheel
  double bearing_friction = 0;   ///< [N m] likewise
  double sense = 1;              ///< 1: the cable turns about a sheave's z, -1: against it
  double retention = infinity;   ///< [N] of a clip
  double capture = 0;            ///< [m] likewise
  std::string cable;             ///< that it holds, or takes
  int frame = 0;                 ///< index into World::frames()
  Pose pose;                     ///< in the frame
  bool is_ready = true;          ///< whether an open clip takes its cable: having let it go not before that was away
  double flow = 0;               ///< [m/s] of material, from before it to after it, at rest length
  double flow_acceleration = 0;  ///< [m/s^2] mean over the last substep
  /// [m] of the cable's rest length that bent places near it lost when their nodes were taken in; the next node that is given out
  /// has it
  double lost_length = 0;
};

/// Where a cable is in a guide.
struct GuideView {
  int cable = -1;                       ///< index into World::cables(), -1: it holds none
  double arc_length = 0;                ///< [m] of the material that is in it, from the start, at rest
  std::array<double, 2> tension{0, 0};  ///< [N] before and after it
};

}  // namespace verlet_cable

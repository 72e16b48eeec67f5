#pragma once

#include <array>
#include <string>

#include "verlet_cable/core/guide_desc.h"
#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// A guide, through which a cable slides. Its attachment holds a node of the cable there, and the cable's material flows through.
struct SimulatedGuide {
  std::string name;
  GuideDesc::Type type = GuideDesc::Type::eyelet;
  double friction = 0;           ///< Coulomb coefficient, may be infinite
  double radius = 0;             ///< [m] of a sheave, to the cable's center line
  double inertia = 0;            ///< [kg m^2] of a sheave's wheel
  double bearing_friction = 0;   ///< [N m] likewise
  double sense = 1;              ///< 1: the cable winds about the z axis of a sheave, -1: about -z
  double retention = infinity;   ///< [N] of a clip
  double capture = 0;            ///< [m] likewise
  std::string cable;             ///< that it holds or, if open, may catch
  int frame = 0;                 ///< index into World::frames()
  Pose pose;                     ///< in the frame
  bool is_ready = true;          ///< whether an open clip may catch its cable: after letting go, only when that has moved away
  double flow = 0;               ///< [m/s] of rest length, from the side before it to the side after it
  double flow_acceleration = 0;  ///< [m/s^2] mean over the last substep
  /// [m] of rest length that was lost where bent parts of the cable had nodes removed beside the guide; it is returned with the
  /// next node that is inserted
  double lost_length = 0;
  /// [J] What the cable lost in energy as nodes passed, below 0 if it gained: given back, or taken, as a segment's length flows
  /// on or back
  double held_energy = 0;
  double held_way = 0;      ///< [m] of rest length that has flowed since the last node passed
  double last_way = 0;      ///< 1: the last node passed forward, -1: backward
  double wheel_energy = 0;  ///< [J] of the material on a sheave's wheel: with the stretch and weight it came with
};

/// State of the cable in a guide.
struct GuideView {
  int cable = -1;                       ///< index into World::cables(), -1: it holds none
  double arc_length = 0;                ///< [m] of the material in the guide, from the start, at rest
  std::array<double, 2> tension{0, 0};  ///< [N] before and after the guide
};

}  // namespace verlet_cable

#pragma once

#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// A point of a cable: on its centre line, or beside it, on the surface, carried along by the segments there as they turn. With
/// i the segment and f the fraction, its displacement is
///   (1 - f) u_i + f u_(i+1) + along (own across . (u_(i+1) - u_i) + before across . (u_i - u_(i-1))),
/// linear in those of three nodes. What turns in the plane of the cable and of the normal carries the point along as a rigid body
/// does; turning about the cable or the normal is left out.
struct CablePoint {
  int cable = -1;  ///< -1: none
  int segment = 0;
  double fraction = 0;  ///< along the segment, 0 to 1
  // Beside the centre line
  Vector3 along = Vector3::Zero();   ///< unit vector of the cable's direction, along the surface
  Vector3 across = Vector3::Zero();  ///< unit vector across the cable, away from the point
  double own = 0;                    ///< how far beside, over the length of the segment,
  double before = 0;                 ///< and of the one before it
};

}  // namespace verlet_cable

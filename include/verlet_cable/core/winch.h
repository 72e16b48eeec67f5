#pragma once

#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// What a winch at an end of a cable does.
struct WinchView {
  enum class Kind {
    length,     ///< it winds to a length, with no more than its greatest tension
    tension,    ///< it keeps a tension
    free_spool  ///< nothing drives it: it lets out what is drawn off
  };
  Kind kind = Kind::length;
  bool at_end = false;
  double goal = 0;                ///< [m] the cable's length or [N] its tension, by its kind; of a free spool 0
  double max_tension = infinity;  ///< [N] of one that winds to a length: above it it stops, or slips
  double tension = 0;             ///< [N] of the segment beside it, in the last substep
  double speed = 0;               ///< [m/s] at which cable leaves it, < 0: it takes in
  bool slips = false;             ///< whether its brake lets cable out
};

}  // namespace verlet_cable

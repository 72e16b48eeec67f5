#pragma once

#include "rod/cable_stepper.h"

namespace verlet_cable {

/// A cable that takes part in a substep.
struct Participant {
  int place = 0;  ///< in its group
  int cable = 0;  ///< as in CablePoint
  CableStepper* stepper = nullptr;
  Substep substep;
  CableState* state = nullptr;
  SubstepResult* result = nullptr;
};

}  // namespace verlet_cable

#pragma once

#include <vector>

#include "contact_set.h"
#include "coupled_stepper.h"

namespace verlet_cable {

/// Buffers of a group's substep. A copy starts with none: they hold nothing beyond the substep, and point into the world.
struct GroupScratch {
  CoupledStepper stepper;
  std::vector<Participant> participants;             ///< the cables that touch something
  std::vector<CableState> before;                    ///< one a cable, at the start of the substep
  std::vector<std::vector<TwistSpan>> spans_before;  ///< likewise
  std::vector<SubstepResult> results;                ///< one a cable
  std::vector<MovingObstacle> obstacles;             ///< over the substep
  std::vector<Intrusion> intrusions;                 ///< found in the step

  GroupScratch() = default;
  GroupScratch(const GroupScratch&) {}
  GroupScratch& operator=(const GroupScratch&) { return *this; }
};

/// Cables that may touch each other: they are advanced in the same substeps.
struct ContactGroup {
  std::vector<int> cables;  ///< ascending
  int level = 0;            ///< a step is tried in 2^level substeps
  ContactSet contacts;
  GroupScratch scratch;
};

}  // namespace verlet_cable

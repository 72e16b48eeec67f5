#pragma once

#include <tbb/enumerable_thread_specific.h>

#include <vector>

#include "body/body_system.h"
#include "contact/body_surfaces.h"
#include "contact/body_touches.h"
#include "contact/contact_set.h"
#include "contact/contact_solver.h"
#include "lanes/lane_stepper.h"
#include "net/constraint_solver.h"
#include "net/spring_stepper.h"
#include "world/islands.h"

namespace verlet_cable {

/// Of a cable while it is stepped.
struct CableWorkspace {
  CableStepper stepper;
  Boundary boundary;
  // At the start of the substep
  CableState before;
  std::vector<TwistSpan> spans_before;
  SubstepResult result;
  double wound = 0;  ///< the part of the step that its drive has wound
};

struct IslandOutcome;
class IslandStepper;

/// A cable that is alone in its island, and that one substep does for the whole step.
struct WaitingCable {
  IslandStepper* stepper = nullptr;  ///< of its world
  Island* island = nullptr;
  IslandOutcome* found = nullptr;
};

/// Those of one law, waiting to be stepped at once.
struct WaitingCables {
  LaneLaw law;
  int lanes = 0;  ///< that they are stepped in, two a cable
  std::vector<WaitingCable> cables;
  std::vector<Boundary> boundaries;  ///< no fewer than there are cables
};

/// Of a step of cables that are stepped together. Holds nothing beyond it.
struct Workspace {
  std::vector<CableWorkspace> cables;  ///< one a cable of the island
  std::vector<MovingObstacle> obstacles;
  BodySurfaces surfaces;  ///< of the bodies of the island
  ContactSet contacts;
  BodyTouches body_touches;
  std::vector<ContactMember> members;     ///< likewise
  std::vector<Participant> participants;  ///< the cables that touch something, or that bodies hold
  ContactSolver contact_solver;
  std::vector<BodyMember> body_members;  ///< the bodies of the island
  std::vector<Vector3> holder_places;    ///< [m] of what holds a body
  BodySystem body_system;
  std::vector<WaitingCables> waiting;  ///< those of one law each
  std::vector<LaneMember> lane_members;
  LaneStepper lane_stepper;
  std::vector<HeldDirection> directions;  ///< of a cable whose energy is measured
};

/// One a thread.
using Workspaces = tbb::enumerable_thread_specific<Workspace>;

/// What solves a net. Follows from its model and from which nodes are held.
struct NetSolver {
  Boundary boundary;
  SpringStepper springs;
  NetConstraintSolver links;
  NetState before;  ///< the step
};

}  // namespace verlet_cable

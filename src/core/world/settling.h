#pragma once

#include <atomic>
#include <limits>
#include <vector>

#include "world/islands.h"
#include "world/state.h"
#include "world/workspace.h"

namespace verlet_cable {

/// Brings a cable into static equilibrium, its holders where they aim: Newton's method, no waiting. Other cables are not there.
class Settling {
 public:
  /// Ends soon after another thread has set `cancelled`.
  Settling(int cable, State& state, Workspace& workspace, const std::atomic<bool>* cancelled = nullptr);
  /// From where the cable is. False if no equilibrium was found; it is then at rest near it.
  bool settle();
  /// A cable that starts, and hangs as if its clamps were hinges, is taken by them in its own directions, and turned to theirs:
  /// that leads to the shape that whoever mounts it would find, where Newton's method alone finds folds and loops. It is not
  /// twisted by that.
  bool settle_start();
  /// Whether the shape that it has by default touches an obstacle.
  bool hangs_into_something();

 private:
  /// On the way to an equilibrium.
  struct Approach {
    explicit Approach(int cable, bool may_touch) : touches(may_touch) { island.cables.push_back(cable); }
    bool touches;                                      ///< looks for what it touches
    bool let_go = false;                               ///< moves, instead of coming to rest
    int iterations = std::numeric_limits<int>::max();  ///< that are left
    Island island;                                     ///< the cable alone
    ContactCache contacts;
  };

  void find_obstacles();
  void hold_still();
  void lie_down();
  void turn_clamps(Approach& approach);
  void place_clamps(const std::vector<Eigen::AngleAxisd>& turns, double part);
  double untwist();
  bool find_untwisted_equilibrium(Approach& approach);
  bool find_equilibrium(Approach& approach);
  bool relax(double h, double longest, int steps, Approach& approach);
  void pass_nodes_of_guides();
  bool leaves_equilibrium(Approach& approach, double& h);
  bool leaves_when_let_go(Approach& approach, double& h);
  SubstepResult advance(Approach& approach, double h);
  void find_contacts(Approach& approach, bool still, double h);
  bool touches(const Approach& approach) const { return approach.touches && !workspace_.contacts.touches().empty(); }
  bool may_touch() const { return !workspace_.obstacles.empty() || state_.scene->contact; }
  void follow_material();
  void complete();

  const std::atomic<bool>* cancelled_;
  int index_;
  State& state_;
  Workspace& workspace_;
  SimulatedCable& cable_;
  CableProgress& memory_;
  CableWorkspace& work_;
};

}  // namespace verlet_cable

#pragma once

#include <atomic>
#include <vector>

#include "world/islands.h"
#include "world/state.h"
#include "world/workspace.h"

namespace verlet_cable {

/// Brings the bodies of an island, and the cables with them, into static equilibrium, their holders where they aim: Newton's
/// method in steps that grow (see Settling). Unlike there, equilibria that do not last are not looked for.
class BodySettling {
 public:
  /// Ends soon after another thread has set `cancelled`.
  BodySettling(const Island& island, State& state, Workspace& workspace, const std::atomic<bool>* cancelled = nullptr);
  /// From where they are. False if no equilibrium was found; they are then at rest near it.
  bool settle();
  /// As they start: clamps on frames take the cables that junctions join as they come to them, whatever roll that is. None is
  /// twisted by bending.
  bool settle_start();
  /// Whether a body that `counts`, a flag a body, is inside an obstacle where they are.
  bool is_inside_obstacle(const std::vector<char>& counts);

 private:
  struct Outcome {
    bool converged = false;
    double displacement = 0;  ///< [m] the largest
    bool touches = false;
  };

  void hold_still();
  Outcome advance(double h);
  void find_joints();
  void pass_nodes_of_guides();
  void complete();
  double untwist();

  const std::atomic<bool>* cancelled_;
  Island island_;
  State& state_;
  Workspace& workspace_;
  double radius_ = infinity;  ///< [m] of the thinnest cable
  double joined_mass_ = 0;    ///< [kg] of the island
  std::vector<ContactCache> contacts_;
  std::vector<CableState> before_;
};

/// Settles what bodies hold: the islands of bodies that have a cable which `settles`, a flag a cable; as they start, if that is
/// so. False if one of them found no equilibrium; `unsettled` gets the names of its cables.
bool settle_bodies(const std::vector<char>& settles, bool start, State& state, Workspace& workspace,
                   std::vector<std::string>& unsettled, const std::atomic<bool>* cancelled = nullptr);

}  // namespace verlet_cable

#pragma once

#include <vector>

#include "geometry/vector_array.h"
#include "rod/substep.h"
#include "verlet_cable/core/cable.h"
#include "verlet_cable/core/ledger.h"

namespace verlet_cable {

/// Drag and buoyancy of the fluid around a cable, node by node. Drag is quadratic, with the diameter as width, for the flow
/// across and along the cable (Morison et al. 1950; coefficients per unit of width): 1/2 density coefficient width length |v| v.
/// In waves the water moves with its surface, as it does in the middle of the substep where the node gets by itself, and its
/// acceleration acts on what the cable displaces (Froude and Krylov); in statics it has none.
class FluidForces {
 public:
  void resize(int nodes);
  void start(const Substep& substep, const CableState& state);
  bool active() const { return active_; }
  /// [m/s] Of the fluid at a node, where it is active.
  Vector3 flow(int node) const { return get(flow_, node); }
  /// Adds the forces [N] to `load`. `rest_lengths`, `middle`: segments [m]; `position`: nodes at the start [m]; `displacement`:
  /// of the nodes [m].
  void add_loads(const std::vector<double>& rest_lengths, const VectorArray& middle, const VectorArray& position,
                 const VectorArray& displacement, VectorArray& load);
  /// Adds the work of the last loads in a substep of h [s]: what is lost against the fluid, and what the fluid adds.
  void add_work(const VectorArray& displacement, double h, EnergyBalance& balance) const;
  /// Adds to the diagonal what `add_loads` found last.
  void add_stiffness(std::vector<double>& diagonal) const;
  /// The force on a node that `add_loads` found last [N].
  Vector3 force(int node) const { return get(force_, node); }

 private:
  void start_water(const Substep& substep, const CableState& state);

  bool active_ = false, any_waves_ = false;
  const FluidDesc* fluid_ = nullptr;
  const GravityDesc* gravity_ = nullptr;
  std::vector<double> radius_, area_radius_;  // nodes [m]: of mean width and of mean section
  double damping_time_ = 0;                   // [s] displacement over it is velocity; infinite in statics
  VectorArray flow_, acceleration_;           // nodes: of the fluid [m/s], [m/s^2]
  std::vector<double> surface_;               // nodes: z of the fluid's surface [m]
  VectorArray force_, drag_;                  // nodes [N]: with buoyancy, and without
  std::vector<double> stiffness_;
};

}  // namespace verlet_cable

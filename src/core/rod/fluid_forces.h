#pragma once

#include <vector>

#include "geometry/vector_array.h"
#include "verlet_cable/core/cable.h"
#include "verlet_cable/core/ledger.h"

namespace verlet_cable {

/// Drag and buoyancy of the fluid around a cable, node by node. Drag is quadratic, with the diameter as width, for the flow
/// across and along the cable (Morison et al. 1950; coefficients per unit of width): 1/2 density coefficient width length |v| v.
class FluidForces {
 public:
  void resize(int nodes);
  /// `damping_time` [s]: displacement over it is velocity; infinite in statics.
  void start(const FluidDesc& fluid, const GravityDesc& gravity, const CableModel& model, const CableState& state,
             double damping_time);
  bool active() const { return active_; }
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
  bool active_ = false;
  FluidDesc fluid_;
  GravityDesc gravity_;
  std::vector<double> radius_, area_radius_;  // nodes [m]: of mean width and of mean section
  double damping_time_ = 0;
  VectorArray force_, drag_;  // nodes [N]: with buoyancy, and without
  std::vector<double> stiffness_;
};

}  // namespace verlet_cable

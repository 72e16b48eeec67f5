#pragma once

#include <vector>

#include "geometry/vector_array.h"
#include "verlet_cable/core/net.h"

namespace verlet_cable {

/// Drag of the fluid on a grid, on each of the two triangles of its cells: 1/2 density normal_drag A |v_n| v_n, a third of it on
/// each corner; nothing on other nets.
class NetWind {
 public:
  void resize(const NetModel& model);
  /// Sets the forces on the nodes [N]. `velocity` [m/s]: of the nodes. A force that would turn its triangle's motion round within
  /// h [s] is reduced: that is no drag any more.
  void evaluate(const NetModel& model, const FluidDesc& fluid, double h, const VectorArray& position,
                const VectorArray& velocity);
  bool active() const { return active_; }
  const VectorArray& force() const { return force_; }

 private:
  bool active_ = false;
  VectorArray force_;     ///< nodes
  VectorArray triangle_;  ///< of one row of cells, a third of the force [N]
};

}  // namespace verlet_cable

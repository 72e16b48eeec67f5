#include "rod/lane_sweep_kernel.h"

namespace verlet_cable {

void sweep_2_lanes(const LaneSweep& sweep) {
  using Lanes = double __attribute__((vector_size(16)));
  sweep_lanes<Lanes>(sweep);
}

}  // namespace verlet_cable

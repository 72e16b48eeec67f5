#include "rod/lane_sweep_kernel.h"

namespace verlet_cable {

void sweep_4_lanes(const LaneSweep& sweep) {
  using Lanes = double __attribute__((vector_size(32)));
  sweep_lanes<Lanes>(sweep);
}

}  // namespace verlet_cable

#include "rod/lane_system.h"

#include <algorithm>

namespace verlet_cable {

void LaneSystem::resize(int nodes, int lanes) {
  const int even = nodes + nodes % 2;
  if (even == nodes_ && lanes == lanes_) return;
  nodes_ = even;
  lanes_ = lanes;
  lane_ = nodes_ / 2 - 1;
  records_.assign(static_cast<std::size_t>(lane_ + 1) * static_cast<int>(LaneField::count) * lanes_, 0.0);
  eliminations_.assign(static_cast<std::size_t>(lane_) * elimination_size * lanes_, 0.0);
  for (int cable = 0; cable < lanes_ / 2; ++cable) clear(cable);
}

void LaneSystem::clear(int cable) {
  for (const int lane : {2 * cable, 2 * cable + 1}) {
    for (int k = 0; k <= lane_; ++k) {
      for (int field = 0; field < static_cast<int>(LaneField::count); ++field) value(static_cast<LaneField>(field), k, lane) = 0;
      value(LaneField::inertia, k, lane) = 1;
      value(LaneField::target_length, k, lane) = 1;
      value(LaneField::axial_stiffness, k, lane) = 1;
    }
  }
}

void LaneSystem::sweep(const LaneLaw& law, const double* active, double* squares) {
  const LaneSweep sweep{law, lane_, records_.data(), eliminations_.data(), active, squares};
  if (lanes_ == 8)
    sweep_8_lanes(sweep);
  else if (lanes_ == 4)
    sweep_4_lanes(sweep);
  else
    sweep_2_lanes(sweep);
}

int widest_lanes() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq")) return 8;
  if (__builtin_cpu_supports("avx2")) return 4;
#endif
  return 2;
}

}  // namespace verlet_cable

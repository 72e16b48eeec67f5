#include "packets/passes.h"

namespace verlet_cable::view {

const PacketPasses& packet_passes() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq")) return passes_of_8();
  if (__builtin_cpu_supports("avx2")) return passes_of_4();
#endif
  return passes_of_2();
}

}  // namespace verlet_cable::view

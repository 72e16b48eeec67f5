#include "packets/kernel.h"

namespace verlet_cable::view {

const PacketPasses& passes_of_4() {
  static constexpr PacketPasses passes = all_passes();
  return passes;
}

}  // namespace verlet_cable::view

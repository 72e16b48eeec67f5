#include "lanes/kernel.h"

namespace verlet_cable {

LanePasses passes_of_8_lanes() {
  return passes_of_lanes<double __attribute__((vector_size(64)))>();
}

}  // namespace verlet_cable

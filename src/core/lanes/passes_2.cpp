#include "lanes/kernel.h"

namespace verlet_cable {

LanePasses passes_of_2_lanes() {
  return passes_of_lanes<double __attribute__((vector_size(16)))>();
}

}  // namespace verlet_cable

#include "simulation/memory_check.h"

#include <unistd.h>

#include "verlet_cable/core/number_text.h"

namespace verlet_cable {

void check_memory(const std::string& what, double bytes) {
  const double memory = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  if (bytes > memory)
    throw TooMuchMemory(what + " take " + rounded_text(bytes / 1e9) + " GB of memory; allowed: at most the " +
                        rounded_text(memory / 1e9) + " GB of this machine");
}

}  // namespace verlet_cable

#pragma once

#include <chrono>
#include <ctime>

namespace verlet_cable::bench {

/// Processor time of this process, all its threads [s]: other load on the machine counts less than in wall time.
inline double processor_seconds() {
  timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Wall time [s], from some time on.
inline double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace verlet_cable::bench

// Recordings of cables, as cable_fit reads them.

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "cable_fit/recording.h"
#include "memory_file.h"
#include "require.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace verlet_cable;
  using namespace verlet_cable::cable_fit;
  const fuzz::MemoryFile file(data, size);
  std::vector<std::string> errors;
  for (const Recording& recording : read_recordings({file.path()}, errors)) {
    if (!errors.empty()) break;
    fuzz::require(std::isfinite(measured_length(recording)), "the length is finite");
    const Recording ordered = in_order(recording, swapped_ends(recording));
    for (const double place : marker_places({&ordered})) fuzz::require(place >= 0 && place <= 1, "markers are on the cable");
    const HeldEnds ends = held_ends(ordered);
    fuzz::require(ends.start.at(0).position.allFinite() && ends.end.at(0).position.allFinite(), "the ends are finite");
  }
  return 0;
}

// Recordings of cables, as cable_fit reads them.

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "cable_fit/recording.h"
#include "memory_file.h"
#include "require.h"

namespace {

bool is_finite(const verlet_cable::Pose& pose) {
  return pose.position.allFinite() && pose.orientation.coeffs().allFinite();
}

}  // namespace

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
    for (const HeldEnds& ends : {held_ends(ordered), held_ends(ordered, usual_directions({&ordered}))})
      fuzz::require(is_finite(ends.start.at(0)) && is_finite(ends.end.at(0)), "the ends are finite");
    for (const Vector3& velocity : initial_velocities(ordered)) fuzz::require(velocity.allFinite(), "velocities are finite");
  }
  return 0;
}

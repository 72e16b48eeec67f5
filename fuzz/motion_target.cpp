// Motions: CSV files, and where they have their frames.

#include <cstddef>
#include <cstdint>

#include "memory_file.h"
#include "require.h"
#include "verlet_cable/core/scene_desc.h"
#include "verlet_cable/scene/motion.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace verlet_cable;
  const fuzz::MemoryFile file(data, size);
  try {
    for (const auto& [name, track] : read_motion_file(file.path())) {
      fuzz::require(!track.empty(), "a track has rows");
      for (const double share : {-1.0, 0.0, 0.3, 1.0, 2.0}) {
        const double time = share * track.last_time();
        const Pose pose = track.at(time);
        const FrameVelocity velocity = track.velocity_from(time);
        fuzz::require(pose.position.allFinite() && pose.orientation.coeffs().allFinite(), name + ": poses are finite");
        fuzz::require(velocity.linear.allFinite() && velocity.angular.allFinite(), name + ": velocities are finite");
      }
    }
  } catch (const SceneError&) {
    // Refused, with its errors.
  }
  return 0;
}

// Robots: URDF.

#include <cstddef>
#include <cstdint>
#include <string>

#include "require.h"
#include "scene/robot_model.h"
#include "verlet_cable/scene/resource.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace verlet_cable;
  try {
    const std::vector<LinkDesc> links = read_urdf(std::string(reinterpret_cast<const char*>(data), size), {});
    for (std::size_t i = 0; i < links.size(); ++i)
      fuzz::require(links[i].parent < static_cast<int>(i), "parents come first: " + links[i].name);
  } catch (const ResourceError&) {
    // Refused, with its reason.
  }
  return 0;
}

#include "shading.h"

#include <cmath>

namespace verlet_cable::view {
namespace {

std::array<std::uint8_t, last_step_of_light + 1> make_bytes() {
  std::array<std::uint8_t, last_step_of_light + 1> bytes;
  for (int k = 0; k <= last_step_of_light; ++k) {
    const double light = static_cast<double>(k) / last_step_of_light;
    const double value = light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
    bytes[k] = static_cast<std::uint8_t>(std::lround(255 * value));
  }
  return bytes;
}

}  // namespace

const std::array<std::uint8_t, last_step_of_light + 1> bytes_of_light = make_bytes();

}  // namespace verlet_cable::view

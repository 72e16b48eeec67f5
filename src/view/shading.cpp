#include "shading.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace verlet_cable::view {
namespace {

constexpr double darker_below = 0.35;  // of the sky's light, on what faces down

constexpr int last_step = 4095;

/// The bytes of evenly spaced amounts of light (IEC 61966-2-1).
std::array<std::uint8_t, last_step + 1> make_bytes() {
  std::array<std::uint8_t, last_step + 1> bytes;
  for (int k = 0; k <= last_step; ++k) {
    const double light = static_cast<double>(k) / last_step;
    const double value = light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
    bytes[k] = static_cast<std::uint8_t>(std::lround(255 * value));
  }
  return bytes;
}

const std::array<std::uint8_t, last_step + 1> bytes_of_light = make_bytes();

}  // namespace

void write_color(const Vector3& light, std::uint8_t* pixel) {
  for (int k = 0; k < 3; ++k)
    pixel[k] = bytes_of_light[static_cast<int>(std::min(std::max(light[k], 0.0), 1.0) * last_step + 0.5)];
}

Vector3 light_from(const Stage::Implementation& stage, const Sighting& seen, const Vector3& direction, bool is_lit) {
  const Paint& paint = *seen.paint;
  const double ambient = stage.drawing.light.ambient, to_sun = seen.normal.dot(stage.to_sun);
  double brightness = ambient * (1 - darker_below * 0.5 * (1 - seen.normal.z()));
  double reflection = 0;
  if (is_lit && to_sun > 0) {
    brightness += (1 - ambient) * to_sun;
    const Vector3 mirrored = direction - 2 * direction.dot(seen.normal) * seen.normal;
    // As Phong has it, with the exponent 32.
    double power = std::max(mirrored.dot(stage.to_sun), 0.0);
    for (int k = 0; k < 5; ++k) power *= power;
    reflection = (1 - ambient) * paint.look.shininess * power;
  }
  const Vector3 color = paint.color + seen.second_color * (paint.second_color - paint.color);
  return brightness * color + Vector3::Constant(reflection);
}

}  // namespace verlet_cable::view

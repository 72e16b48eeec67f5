#include "shading.h"

#include <algorithm>
#include <cmath>

namespace verlet_cable::view {
namespace {

constexpr double darker_below = 0.35;  // of the sky's light, on what faces down

/// The bytes of evenly spaced amounts of light (IEC 61966-2-1).
struct ByteTable {
  static constexpr int last = 4095;
  std::array<std::uint8_t, last + 1> bytes;

  ByteTable() {
    for (int k = 0; k <= last; ++k) {
      const double light = static_cast<double>(k) / last;
      const double value = light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
      bytes[k] = static_cast<std::uint8_t>(std::lround(255 * value));
    }
  }
};

}  // namespace

std::array<std::uint8_t, 3> pixel_color(const Vector3& light) {
  static const ByteTable table;
  std::array<std::uint8_t, 3> color;
  for (int k = 0; k < 3; ++k) color[k] = table.bytes[static_cast<int>(std::clamp(light[k], 0.0, 1.0) * ByteTable::last + 0.5)];
  return color;
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

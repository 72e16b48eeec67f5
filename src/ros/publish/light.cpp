#include "publish/light.h"

#include <cmath>

namespace verlet_cable {
namespace {

const Vector3 to_light = Vector3(-0.4, -0.6, 0.7).normalized();
constexpr double darkest_outside = 0.45;  // of what faces away from the light
constexpr double darkest_sheet = 0.35;    // of what the light passes along

std_msgs::ColorRGBA scaled(const std_msgs::ColorRGBA& color, double brightness) {
  std_msgs::ColorRGBA scaled = color;
  scaled.r *= static_cast<float>(brightness);
  scaled.g *= static_cast<float>(brightness);
  scaled.b *= static_cast<float>(brightness);
  return scaled;
}

}  // namespace

std_msgs::ColorRGBA lit(const std_msgs::ColorRGBA& color, const Vector3& normal) {
  return scaled(color, darkest_outside + (1 - darkest_outside) * 0.5 * (1 + normal.dot(to_light)));
}

std_msgs::ColorRGBA lit_from_both_sides(const std_msgs::ColorRGBA& color, const Vector3& normal) {
  return scaled(color, darkest_sheet + (1 - darkest_sheet) * std::abs(normal.dot(to_light)));
}

}  // namespace verlet_cable

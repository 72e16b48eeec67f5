#include "fluid/waves.h"

#include <algorithm>
#include <cmath>

namespace verlet_cable {

namespace {

constexpr int most_iterations = 50;
/// Corrections of the wave number that are smaller than this, relative, are rounding.
constexpr double rounding_of_wave_number = 1e-15;

}  // namespace

double wave_number(double frequency, double gravity, double depth) {
  const double deep = frequency * frequency / gravity;
  if (deep * depth == infinity) return deep;
  // x = number depth, x tanh x = y; begun within a fifth of the solution.
  const double y = deep * depth;
  double x = std::max(y, std::sqrt(y));
  for (int i = 0; i < most_iterations; ++i) {
    const double t = std::tanh(x), change = (x * t - y) / (t + x * (1 - t * t));
    x -= change;
    if (std::abs(change) <= rounding_of_wave_number * x) break;
  }
  return x / depth;
}

std::vector<Wave> waves_of(const SceneDesc& scene) {
  std::vector<Wave> waves;
  for (const WaveDesc& desc : scene.fluid.waves) {
    Wave& wave = waves.emplace_back();
    wave.frequency = 2 * M_PI / desc.period;
    wave.number = wave_number(wave.frequency, scene.gravity.acceleration.norm(), scene.fluid.depth);
    wave.direction = {std::cos(desc.direction), std::sin(desc.direction), 0};
    wave.amplitude = desc.amplitude;
    wave.phase = desc.phase;
  }
  return waves;
}

WaterMotion water_at(const FluidDesc& fluid, const std::vector<Wave>& waves, const Vector3& point, double time) {
  WaterMotion water{fluid.surface, fluid.velocity, Vector3::Zero()};
  const double height = std::clamp(point.z() - fluid.surface, -fluid.depth, 0.0);
  const bool is_between = height == point.z() - fluid.surface;  // elsewhere nothing changes with the height
  Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
  for (const Wave& wave : waves) {
    const double angle = wave.number * wave.direction.dot(point) - wave.frequency * time + wave.phase;
    const double cosine = std::cos(angle), sine = std::sin(angle);
    // cosh(k (z + d)) / sinh(k d) and sinh(k (z + d)) / sinh(k d), so that they are numbers in deep water, too
    const double down = std::exp(wave.number * height), up = std::exp(-wave.number * (height + 2 * fluid.depth)),
                 scale = -std::expm1(-2 * wave.number * fluid.depth), along = (down + up) / scale, upright = (down - up) / scale;
    const double speed = wave.amplitude * wave.frequency;
    water.surface += wave.amplitude * cosine;
    water.velocity += speed * along * cosine * wave.direction + Vector3(0, 0, speed * upright * sine);
    water.acceleration +=
        wave.frequency * speed * along * sine * wave.direction - Vector3(0, 0, wave.frequency * speed * upright * cosine);
    const double steepness = speed * wave.number;
    gradient +=
        (Vector3(0, 0, steepness * upright * cosine) - steepness * along * sine * wave.direction) * wave.direction.transpose();
    if (is_between) gradient.col(2) += steepness * upright * cosine * wave.direction + Vector3(0, 0, steepness * along * sine);
  }
  water.acceleration += gradient * water.velocity;
  return water;
}

}  // namespace verlet_cable

#include "contact/cable_stretches.h"

#include <algorithm>

#include "verlet_cable/core/cable_materials.h"

namespace verlet_cable {
namespace {

constexpr int longest_stretch = 32;  // segments

}  // namespace

void CableStretches::update(const SimulatedCable& cable) {
  const CableMaterials materials(cable);
  const CableState& state = cable.state;
  const int n = state.segments();
  radii_.assign(n + 1, cable.model->material.radius);
  if (materials.vary())
    for (int i = 0; i <= n; ++i) radii_[i] = std::max(materials[std::max(i - 1, 0)].radius, materials[std::min(i, n - 1)].radius);
  speeds_.resize(n + 1);
  for (int i = 0; i <= n; ++i) speeds_[i] = state.velocities[i].norm();
  stretches_.clear();
  for (int first = 0; first < n; first += longest_stretch) {
    Stretch& stretch = stretches_.emplace_back();
    stretch.first = first;
    stretch.end = std::min(n, first + longest_stretch);
    for (int i = first; i <= stretch.end; ++i) {
      stretch.box.extend(state.positions[i]);
      stretch.radius = std::max(stretch.radius, radii_[i]);
      stretch.speed = std::max(stretch.speed, speeds_[i]);
    }
  }
}

}  // namespace verlet_cable

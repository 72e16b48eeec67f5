#include "rod/material_spin.h"

#include <algorithm>
#include <cmath>

#include "rod/material_frames.h"
#include "rod/twist.h"
#include "verlet_cable/core/cable_materials.h"

namespace verlet_cable {

namespace {

struct SegmentMotion {
  Vector3 direction, rate;  ///< unit vector; [1/s] of it
};

/// Over about the last substep: of the velocities without what alternates from one to the next.
SegmentMotion motion_of(const CableState& state, const VectorArray& segment, double h, int i) {
  const Vector3 d = get(segment, i);
  const double inverse = 1 / d.norm();
  const Vector3 velocity = state.velocities[i + 1] - state.velocities[i];
  const Vector3 mean_velocity = velocity - 0.5 * h * (state.accelerations[i + 1] - state.accelerations[i]);
  const Vector3 direction = inverse * d, rate = inverse * mean_velocity;
  return {direction, rate - direction.dot(rate) * direction};
}

}  // namespace

double spin_of(const HeldDirection& target, double h) {
  return rotation_between(target.start, target.end).dot(target.end * Vector3::UnitX()) / h;
}

void find_material_spin(const CableModel& model, const CableState& state, const VectorArray& segment,
                        const std::vector<HeldDirection>& directions, const std::vector<double>& damping, double h,
                        std::vector<double>& spin) {
  const int n = state.segments();
  // Of a cable that does not twist, relative to its first segment: neighbouring frames that follow their directions by the
  // smallest rotations would turn against each other at this rate (Bergou et al., Discrete Elastic Rods, 2008, section 6).
  double square = 0, along = 0;
  spin[0] = 0;
  SegmentMotion before = motion_of(state, segment, h, 0);
  for (int i = 1; i < n; ++i) {
    const SegmentMotion after = motion_of(state, segment, h, i);
    const double cosine = std::max(1 + before.direction.dot(after.direction), smallest_turn);
    const Vector3 half_binormal = before.direction.cross(after.direction) / cosine;
    spin[i] = spin[i - 1] - half_binormal.dot(before.rate + after.rate);
    // As `turning_rate`, of the change of direction at a spin of one
    const Vector3 turned = std::sqrt(2 * cosine) * half_binormal;
    square += damping[i] * turned.squaredNorm();
    along += damping[i] * turned.dot(after.rate - before.rate - 0.5 * (spin[i - 1] + spin[i]) * turned);
    before = after;
  }
  const CableMaterials materials(model, state);
  const bool passed_on = materials.any(
      [](const MaterialDesc& material) { return material.torsional_stiffness > 0 || material.torsional_damping > 0; });
  if (directions.empty() || !passed_on) {
    const double common = square > 0 ? along / square : 0;
    for (int i = 0; i < n; ++i) spin[i] += common;
    return;
  }
  const auto missing_at = [&](const HeldDirection& clamp) { return spin_of(clamp, h) - spin[std::min(clamp.node, n - 1)]; };
  int done = 0;
  for (std::size_t k = 0; k <= directions.size(); ++k) {
    const double first = missing_at(directions[k == 0 ? 0 : k - 1]);
    const double last = missing_at(directions[std::min(k, directions.size() - 1)]);
    const int end = k < directions.size() ? directions[k].node : n;
    if (materials.vary() && done < end) {
      const Series series = torsion_of(materials, state, done, end);
      double before = 0;
      for (int i = done; i < end; ++i) {
        const double share = twist_share(series, materials, state, i);
        spin[i] += first + (last - first) * (before + 0.5 * share);
        before += share;
      }
    } else {
      for (int i = done; i < end; ++i) spin[i] += first + (last - first) * (i + 0.5 - done) / (end - done);
    }
    done = std::max(done, end);
  }
}

}  // namespace verlet_cable

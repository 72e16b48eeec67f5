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

void MaterialSpin::resize(int segments) {
  own_.assign(segments, 0.0);
  driven_.assign(segments, 0.0);
  shares_.assign(segments, {});
}

void MaterialSpin::find(const CableModel& model, const CableState& state, const VectorArray& segment,
                        const std::vector<HeldDirection>& directions, const std::vector<double>& damping, double h) {
  const int n = state.segments();
  find_own(state, segment, damping, h);
  const bool passed_on = CableMaterials(model, state).any([](const MaterialDesc& material) {
    return material.torsional_stiffness > 0 || material.torsional_damping > 0;
  });
  if (directions.empty() || !passed_on) {
    for (int i = 0; i < n; ++i) own_[i] += common_;
    driven_.assign(n, 0.0);
    shares_.assign(n, {});
    return;
  }
  const int count = static_cast<int>(directions.size());
  int done = 0;
  for (int k = 0; k <= count; ++k) {
    const int end = k < count ? directions[k].node : n;
    if (done < end) turn_with_clamps(std::max(k - 1, 0), std::min(k, count - 1), done, end, model, state, directions, h);
    done = std::max(done, end);
  }
}

/// Of a cable that does not twist, relative to its first segment: neighbouring frames that follow their directions by the
/// smallest rotations would turn against each other at this rate (Bergou et al., Discrete Elastic Rods, 2008, section 6).
void MaterialSpin::find_own(const CableState& state, const VectorArray& segment, const std::vector<double>& damping, double h) {
  double square = 0, along = 0;
  own_[0] = 0;
  SegmentMotion before = motion_of(state, segment, h, 0);
  for (int i = 1; i < state.segments(); ++i) {
    const SegmentMotion after = motion_of(state, segment, h, i);
    const double cosine = std::max(1 + before.direction.dot(after.direction), smallest_turn);
    const Vector3 half_binormal = before.direction.cross(after.direction) / cosine;
    own_[i] = own_[i - 1] - half_binormal.dot(before.rate + after.rate);
    // As `turn_of` the change of direction
    const Vector3 turned = std::sqrt(2 * cosine) * half_binormal;
    square += damping[i] * turned.squaredNorm();
    along += damping[i] * turned.dot(after.rate - before.rate - own(i) * turned);
    before = after;
  }
  common_ = square > 0 ? along / square : 0;
}

/// Segments `from` to `to`, between two clamps, or beyond one.
void MaterialSpin::turn_with_clamps(int first, int last, int from, int to, const CableModel& model, const CableState& state,
                                    const std::vector<HeldDirection>& directions, double h) {
  const int n = state.segments();
  const auto own_at = [&](int clamp) { return own_[std::min(directions[clamp].node, n - 1)]; };
  const double own_first = own_at(first), own_change = own_at(last) - own_first;
  const double driven_first = spin_of(directions[first], h), driven_change = spin_of(directions[last], h) - driven_first;
  const CableMaterials materials(model, state);
  const Series series = materials.vary() ? torsion_of(materials, state, from, to) : Series();
  double before = 0;
  for (int i = from; i < to; ++i) {
    const double share = materials.vary() ? twist_share(series, materials, state, i) : 1.0 / (to - from);
    const double of_last = first == last ? 0 : before + 0.5 * share;
    before += share;
    own_[i] -= own_first + own_change * of_last;
    driven_[i] = driven_first + driven_change * of_last;
    shares_[i] = {first, last, of_last};
  }
}

void MaterialSpin::pass_on(int node, double torque, std::vector<HeldDirection>& directions) const {
  const auto add = [&](int clamp, double part) {
    directions[clamp].torque += part * torque * (directions[clamp].end * Vector3::UnitX());
  };
  for (const int i : {node - 1, node}) {
    const Share& share = shares_[i];
    if (share.first < 0) continue;
    add(share.first, 0.5 * (1 - share.of_last));
    add(share.last, 0.5 * share.of_last);
  }
}

}  // namespace verlet_cable

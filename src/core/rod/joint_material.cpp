#include "rod/joint_material.h"

#include <algorithm>
#include <utility>

#include "rod/series.h"

namespace verlet_cable {

namespace {

/// [N m]
double yield_moment(const MaterialDesc& material) {
  return material.hardening < 1 ? material.bending_stiffness.smallest() * material.yield_curvature : infinity;
}

/// `first` and `second` [m]: the lengths of cable of the materials `before` and `after`, of which `joint` has the stiffness.
void find_yielding(const MaterialDesc& before, double first, const MaterialDesc& after, double second, JointMaterial& joint) {
  const double length = first + second, stiffness = joint.bending_stiffness.smallest();
  joint.bending_friction = (first * before.bending_friction + second * after.bending_friction) / length;
  const double moment = std::min(yield_moment(before), yield_moment(after));
  joint.yield_curvature = infinity;
  joint.hardening = 0;
  if (!(moment < infinity && stiffness > 0)) return;
  joint.yield_curvature = moment / stiffness;
  Series beyond;
  for (const auto& [material, part] : {std::pair{&before, first}, std::pair{&after, second}}) {
    const double left = yield_moment(*material) > moment ? 1 : material->hardening;
    beyond.add(part, left * material->bending_stiffness.smallest(), 0);
  }
  joint.hardening = length * beyond.stiffness() / stiffness;
}

}  // namespace

JointMaterial joint_material(const CableMaterials& materials, const CableState& state, int node) {
  const MaterialDesc &before = materials[node - 1], &after = materials[node];
  JointMaterial joint(before);
  const bool remembers = before.remembers_bending() || after.remembers_bending();
  const auto resist_twist = [remembers](JointMaterial& of) {
    if (remembers && of.torsional_stiffness == 0) of.torsional_stiffness = of.bending_stiffness.smallest();
  };
  if (&before == &after) {
    resist_twist(joint);
    return joint;
  }
  const double first = 0.5 * state.rest_lengths[node - 1], second = 0.5 * state.rest_lengths[node], length = first + second;
  joint.bending_damping = 0;
  for (const int axis : {0, 1}) {
    Series bend;
    bend.add(first, before.bending_stiffness[axis], before.bending_damping);
    bend.add(second, after.bending_stiffness[axis], after.bending_damping);
    joint.bending_stiffness[axis] = length * bend.stiffness();
    joint.bending_damping += 0.5 * length * bend.damping();
  }
  Series twist;
  twist.add(first, before.torsional_stiffness, before.torsional_damping);
  twist.add(second, after.torsional_stiffness, after.torsional_damping);
  joint.torsional_stiffness = length * twist.stiffness();
  joint.torsional_damping = length * twist.damping();
  if (remembers) find_yielding(before, first, after, second, joint);
  resist_twist(joint);
  return joint;
}

std::array<double, 2> curvature_beside(const CableMaterials& materials, const CableState& state, int node, double angle) {
  const MaterialDesc &before = materials[node - 1], &after = materials[node];
  const double first = 0.5 * state.rest_lengths[node - 1], second = 0.5 * state.rest_lengths[node];
  if (&before == &after) return {angle / (first + second), angle / (first + second)};
  Series bend;
  const auto share = [&](const MaterialDesc& material, double length) {
    return bend.share(length, material.bending_stiffness.smallest(), material.bending_damping);
  };
  bend.add(first, before.bending_stiffness.smallest(), before.bending_damping);
  bend.add(second, after.bending_stiffness.smallest(), after.bending_damping);
  return {angle * share(before, first) / first, angle * share(after, second) / second};
}

}  // namespace verlet_cable

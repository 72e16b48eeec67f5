#include "rod/joint_material.h"

#include "rod/series.h"

namespace verlet_cable {

JointMaterial joint_material(const CableMaterials& materials, const CableState& state, int node) {
  const MaterialDesc &before = materials[node - 1], &after = materials[node];
  JointMaterial joint(before);
  if (&before == &after) return joint;
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

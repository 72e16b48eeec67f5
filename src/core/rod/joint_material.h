#pragma once

#include "verlet_cable/core/cable_materials.h"

namespace verlet_cable {

/// What resists bending and twist at a joint, per length of the cable that it stands for.
struct JointMaterial {
  BendingStiffness bending_stiffness;  ///< [N m^2] about y and z
  double bending_damping = 0;          ///< [N m^2 s]
  double torsional_stiffness = 0;      ///< [N m^2]
  double torsional_damping = 0;        ///< [N m^2 s]
  double yield_curvature = infinity;   ///< [1/m]
  double hardening = 0;
  double bending_friction = 0;  ///< [N m]

  /// Of a joint beside a clamp, which stands for half a segment.
  explicit JointMaterial(const MaterialDesc& material)
      : bending_stiffness(material.bending_stiffness),
        bending_damping(material.bending_damping),
        torsional_stiffness(material.torsional_stiffness),
        torsional_damping(material.torsional_damping),
        yield_curvature(material.yield_curvature),
        hardening(material.hardening),
        bending_friction(material.bending_friction) {}
};

/// Of the joint at an inner node, which stands for half of each segment beside it, one after the other: see Series. It yields
/// where the weaker of them does. What remembers how it was bent is twisted as hard as it is bent, if its material says nothing:
/// or it would turn about itself rather than be bent anew.
JointMaterial joint_material(const CableMaterials& materials, const CableState& state, int node);

}  // namespace verlet_cable

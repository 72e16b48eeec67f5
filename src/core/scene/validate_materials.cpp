#include "scene/validate_materials.h"

namespace verlet_cable {

namespace {

bool has_sound_bending_stiffness(const MaterialDesc& material) {
  const BendingStiffness& stiffness = material.bending_stiffness;
  return bending_stiffness_field.range.contains(stiffness.front()) && bending_stiffness_field.range.contains(stiffness.back());
}

void check_bending_stiffness(const std::string& prefix, const MaterialDesc& material, Errors& errors) {
  if (has_sound_bending_stiffness(material)) return;
  const auto& [key, member, unit, range, required] = bending_stiffness_field;
  const BendingStiffness& stiffness = material.bending_stiffness;
  errors.add(prefix + key, stiffness.is_isotropic() ? number_text(stiffness.front()) : list_text(stiffness), range.text(unit));
}

/// Over the smaller bending stiffness: of a round section of rubber or metal, and of a thin strip of it (Timoshenko, Strength of
/// Materials).
constexpr double round_torsion = 0.75, strip_torsion = 1.4;

/// Where bending depends on how the material is turned about the cable, something must resist its turning.
void require_torsional_stiffness(const std::string& name, const MaterialDesc& material, const std::string& why, Errors& errors) {
  const BendingStiffness& stiffness = material.bending_stiffness;
  if (material.torsional_stiffness != 0 || !has_sound_bending_stiffness(material)) return;
  const double ratio = stiffness.is_isotropic() ? round_torsion : strip_torsion, likely = ratio * stiffness.smallest();
  errors.add("materials." + escaped(name) + ".torsional_stiffness", number_text(material.torsional_stiffness),
             "any number above 0 [N m^2] " + why + " (" + (stiffness.is_isotropic() ? "a round section" : "a thin strip") +
                 " has about " + number_text(ratio) + " times its " + (stiffness.is_isotropic() ? "" : "smaller ") +
                 "bending_stiffness" + (likely > 0 ? ", " + rounded_text(likely) : "") + ")");
}

}  // namespace

void check_materials(const SceneDesc& scene, Errors& errors) {
  UniqueNames materials;
  for (const NamedMaterial& named : scene.materials) {
    materials.check("materials." + escaped(named.name), named.name, errors);
    check_fields("materials." + escaped(named.name) + ".", material_fields, named.material, errors);
    check_bending_stiffness("materials." + escaped(named.name) + ".", named.material, errors);
    if (!named.material.bending_stiffness.is_isotropic())
      require_torsional_stiffness(named.name, named.material, "with a bending_stiffness that differs about y and z", errors);
  }
}

void check_damping(const std::string& key, const SceneDesc& scene, const CableDesc& cable, const MaterialDesc& material,
                   Errors& errors) {
  if (!has_sound_size(cable) || !material_fields[0].range.contains(material.linear_density) ||
      !scene_fields[0].range.contains(scene.time_step))
    return;
  constexpr double largest_ratio = 1e12;
  const double length = cable.length / cable.segments;
  const double axial = largest_ratio * material.linear_density * length * length / scene.time_step;
  const double bending = axial * length * length;
  struct Limit {
    const char* key;
    double value;
    double most;
    const char* unit;
    const char* words;
  };
  for (const Limit& limit : {Limit{"axial_damping", material.axial_damping, axial, "N s", "segment length^2"},
                             Limit{"bending_damping", material.bending_damping, bending, "N m^2 s", "segment length^4"},
                             Limit{"torsional_damping", material.torsional_damping, bending, "N m^2 s", "segment length^4"}}) {
    // What is out of its range is an error of the material already.
    if (limit.value <= limit.most || !not_negative.contains(limit.value)) continue;
    errors.add("materials." + escaped(cable.material) + "." + limit.key, number_text(limit.value),
               "at most " + rounded_bound_text(limit.most, -1) + " [" + limit.unit + "] for " + key + ", " +
                   number_text(largest_ratio) + " linear_density " + limit.words +
                   " / time_step, the most that can be simulated at this time_step");
  }
}

void check_torsional_stiffness(const std::string& key, const CableDesc& cable, const MaterialDesc& material, Errors& errors) {
  // What bends unequally needs it anyhow.
  if (!material.bending_stiffness.is_isotropic()) return;
  if (!cable.rest_curvature.is_straight() && material.bending_stiffness.largest() > 0)
    require_torsional_stiffness(cable.material, material, "with bending_stiffness, as " + key + " has rest_curvature", errors);
  else if (cable.rest_twist != 0 && cable_fields[1].range.contains(cable.rest_twist))
    require_torsional_stiffness(cable.material, material, "as " + key + " has rest_twist", errors);
}

void check_torsional_stiffness(const SimulatedCable& cable, const MaterialDesc& material, Errors& errors) {
  const bool is_curved = !cable.state.rest_curvature.empty() && material.bending_stiffness.largest() > 0;
  if (is_curved || !cable.state.rest_twist.empty())
    require_torsional_stiffness(cable.model->material_name, material,
                                "as cable " + cable.model->name + " has " + (is_curved ? "rest_curvature" : "rest_twist"), errors);
}

}  // namespace verlet_cable

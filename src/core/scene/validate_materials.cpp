#include "scene/validate_materials.h"

#include <algorithm>
#include <vector>

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

/// What yields, or whose strands rub, does so as it is bent: where nothing resists that, there is nothing to yield.
void check_bending_memory(const std::string& prefix, const MaterialDesc& material, Errors& errors) {
  if (!has_sound_bending_stiffness(material) || material.bending_stiffness.smallest() > 0) return;
  const std::string why = " for a material without bending_stiffness" +
                          std::string(material.bending_stiffness.is_isotropic() ? "" : " about both y and z");
  if (material.yield_curvature < infinity && positive_or_infinite.contains(material.yield_curvature))
    errors.add(prefix + "yield_curvature", number_text(material.yield_curvature), ".inf [1/m]" + why);
  if (material.bending_friction > 0 && not_negative.contains(material.bending_friction))
    errors.add(prefix + "bending_friction", number_text(material.bending_friction), "0 [N m]" + why);
}

}  // namespace

void check_materials(const SceneDesc& scene, Errors& errors) {
  UniqueNames materials;
  for (const NamedMaterial& named : scene.materials) {
    materials.check("materials." + escaped(named.name), named.name, errors);
    check_fields("materials." + escaped(named.name) + ".", material_fields, named.material, errors);
    check_bending_stiffness("materials." + escaped(named.name) + ".", named.material, errors);
    check_bending_memory("materials." + escaped(named.name) + ".", named.material, errors);
    if (!named.material.bending_stiffness.is_isotropic())
      require_torsional_stiffness(named.name, named.material, "with a bending_stiffness that differs about y and z", errors);
  }
}

std::vector<NamedMaterial> materials_of(const SceneDesc& scene, const CableDesc& cable) {
  std::vector<NamedMaterial> materials;
  const auto add = [&](const std::string& name) {
    const auto is_it = [&](const NamedMaterial& other) { return other.name == name; };
    const MaterialDesc* material = scene.find_material(name);
    if (material && std::none_of(materials.begin(), materials.end(), is_it)) materials.push_back({name, *material});
  };
  add(cable.material);
  for (const SectionDesc& section : cable.sections) add(section.material);
  return materials;
}

void check_damping(const std::string& key, const SceneDesc& scene, const CableDesc& cable, const NamedMaterial& named,
                   Errors& errors) {
  const auto& [name, material] = named;
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
    errors.add("materials." + escaped(name) + "." + limit.key, number_text(limit.value),
               "at most " + rounded_bound_text(limit.most, -1) + " [" + limit.unit + "] for " + key + ", " +
                   number_text(largest_ratio) + " linear_density " + limit.words +
                   " / time_step, the most that can be simulated at this time_step");
  }
}

namespace {

/// `curved`, `twisted`: in words, why a cable of these materials has frames; empty where it has no such rest shape.
void check_torsional_stiffness(const std::string& cable, const std::vector<NamedMaterial>& materials, const std::string& curved,
                               const std::string& twisted, Errors& errors) {
  const auto bends = [](const NamedMaterial& m) { return m.material.bending_stiffness.largest() > 0; };
  const auto is_unequal = [](const NamedMaterial& m) { return !m.material.bending_stiffness.is_isotropic(); };
  const auto unequal = std::find_if(materials.begin(), materials.end(), is_unequal);
  const bool is_curved = !curved.empty() && std::any_of(materials.begin(), materials.end(), bends);
  std::string why;
  if (unequal != materials.end())
    why = "as " + cable + " is of " + escaped(unequal->name) + ", too, whose bending_stiffness differs about y and z";
  else if (is_curved)
    why = materials.size() > 1 ? "as " + curved : "with bending_stiffness, as " + curved;
  else if (!twisted.empty())
    why = "as " + twisted;
  else
    return;
  // What bends unequally needs it anyhow.
  for (const NamedMaterial& named : materials)
    if (!is_unequal(named)) require_torsional_stiffness(named.name, named.material, why, errors);
}

}  // namespace

void check_torsional_stiffness(const std::string& key, const SceneDesc& scene, const CableDesc& cable, Errors& errors) {
  const bool is_twisted = cable.rest_twist != 0 && cable_fields[1].range.contains(cable.rest_twist);
  check_torsional_stiffness(key, materials_of(scene, cable),
                            cable.rest_curvature.is_straight() ? "" : key + " has rest_curvature",
                            is_twisted ? key + " has rest_twist" : "", errors);
}

void check_torsional_stiffness(const SimulatedCable& cable, const SceneDesc& scene, Errors& errors) {
  const std::string name = "cable " + cable.model->name;
  const auto in_scene = [&](const std::string& material) { return NamedMaterial{material, *scene.find_material(material)}; };
  std::vector<NamedMaterial> materials{in_scene(cable.model->material_name)};
  for (const NamedMaterial& other : cable.model->section_materials) materials.push_back(in_scene(other.name));
  check_torsional_stiffness(name, materials, cable.state.rest_curvature.empty() ? "" : name + " has rest_curvature",
                            cable.state.rest_twist.empty() ? "" : name + " has rest_twist", errors);
}

}  // namespace verlet_cable

#include "simulation/batch_materials.h"

#include <algorithm>
#include <utility>

#include "scene/text.h"
#include "simulation/quantity.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/quoted_text.h"
#include "verlet_cable/core/scene_fields.h"

namespace verlet_cable {
namespace {

void change(const Field<MaterialDesc>& field, MaterialDesc& material, const BendingStiffness& value) {
  material.*field.member = value.front();
}

std::string material_keys() {
  std::string text = bending_stiffness_field.key;
  for (const auto& field : material_fields) text += std::string(", ") + field.key;
  return text;
}

/// Changes a material of the scene of world `index`; what is wrong is added to `errors`.
void change(const std::string& path, const MaterialChange& wanted, std::size_t index, MaterialDesc& material,
            std::vector<std::string>& errors) {
  const BendingStiffness& value = wanted.values[index];
  const auto check = [&](const auto& field) {
    for (const double number : value)
      if (!field.range.contains(number)) {
        errors.push_back(path + "." + wanted.field + "[" + std::to_string(index) + "]: " + number_text(number) +
                         "; allowed: " + field.range.text(field.unit));
        return;
      }
  };
  if (wanted.field == bending_stiffness_field.key) {
    check(bending_stiffness_field);
    material.bending_stiffness = value;
    return;
  }
  for (const auto& field : material_fields) {
    if (wanted.field != field.key) continue;
    check(field);
    change(field, material, value);
  }
}

bool is_material_field(const std::string& name) {
  return name == bending_stiffness_field.key ||
         std::any_of(material_fields.begin(), material_fields.end(), [&](const auto& field) { return name == field.key; });
}

/// Which key was meant, in brackets, or nothing.
std::string meant(const std::string& field) {
  std::vector<std::string> keys{bending_stiffness_field.key};
  for (const auto& other : material_fields) keys.push_back(other.key);
  const std::string nearest = nearest_name(field, keys);
  return nearest.empty() ? "" : " (did you mean " + nearest + "?)";
}

void check_names(const std::string& material, const std::vector<MaterialChange>& changes, const SceneDesc& scene) {
  if (!scene.find_material(material))
    throw UnknownName("name: " + in_quotes(material) + "; allowed: " + material_names(scene.materials));
  for (const MaterialChange& wanted : changes)
    if (!is_material_field(wanted.field))
      throw UnknownName("materials." + material + "." + escaped(wanted.field) + ": no such key; allowed: " + material_keys() +
                        meant(wanted.field));
}

/// Masses are given to worlds when they begin, and by no tuning.
void check_masses(const std::string& material, const std::vector<MaterialChange>& changes, const std::vector<DrivenWorld>& worlds,
                  std::vector<std::string>& errors) {
  if (std::none_of(changes.begin(), changes.end(), [](const auto& wanted) { return wanted.field == "linear_density"; })) return;
  const auto changed = std::find_if_not(worlds.begin(), worlds.end(), [](const auto& world) { return world.is_as_it_began(); });
  if (changed != worlds.end())
    errors.push_back("materials." + material + ".linear_density: given when world " + std::to_string(changed - worlds.begin()) +
                     " was stepped, settled or edited; allowed: before the first step, settling and editing of all worlds");
}

}  // namespace

std::vector<std::shared_ptr<const SceneDesc>> scenes_with(const std::string& material, const std::vector<MaterialChange>& changes,
                                                          const std::vector<DrivenWorld>& worlds) {
  check_names(material, changes, worlds.front().scene());
  std::vector<std::string> errors;
  check_masses(material, changes, worlds, errors);
  std::vector<std::shared_ptr<const SceneDesc>> scenes;
  for (std::size_t i = 0; i < worlds.size() && errors.size() < most_errors; ++i) {
    SceneDesc scene = worlds[i].scene();
    for (NamedMaterial& other : scene.materials) {
      if (other.name != material) continue;
      for (const MaterialChange& wanted : changes) change("materials." + material, wanted, i, other.material, errors);
    }
    scenes.push_back(std::make_shared<SceneDesc>(std::move(scene)));
  }
  for (std::size_t i = 0; i < scenes.size() && errors.empty(); ++i)
    for (const std::string& line : validate(*scenes[i])) errors.push_back("world " + std::to_string(i) + ": " + line);
  if (!errors.empty()) throw SceneError(std::move(errors));
  return scenes;
}

}  // namespace verlet_cable

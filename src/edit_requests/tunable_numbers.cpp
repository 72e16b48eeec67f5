#include "edit_requests/tunable_numbers.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "verlet_cable/core/name_list.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/quoted_text.h"

namespace verlet_cable {
namespace {

/// Dampings, stiffnesses and friction: what does not change masses or shapes.
constexpr double MaterialDesc::*tunable_of_material[] = {
    &MaterialDesc::axial_stiffness, &MaterialDesc::torsional_stiffness, &MaterialDesc::axial_damping,
    &MaterialDesc::bending_damping, &MaterialDesc::torsional_damping,   &MaterialDesc::drag,
    &MaterialDesc::friction,        &MaterialDesc::rolling_friction,    &MaterialDesc::yield_curvature,
    &MaterialDesc::hardening,       &MaterialDesc::bending_friction};

template <class Part>
void add_vector(const std::string& name, const std::string& description, Part SceneDesc::*part, Vector3 Part::*vector,
                std::vector<TunableNumber>& numbers) {
  const char* axes[] = {"_x", "_y", "_z"};
  for (int axis = 0; axis < 3; ++axis)
    numbers.push_back({name + axes[axis], description, coordinate,
                       [=](const SceneDesc& scene) { return (scene.*part.*vector)[axis]; },
                       [=](SceneDesc& scene, double value) { (scene.*part.*vector)[axis] = value; }});
}

/// Of a material that bends alike about all axes one number, which stays so; else one an axis.
void add_bending_stiffness(const SceneDesc& scene, std::size_t material, std::vector<TunableNumber>& numbers) {
  const auto& [key, member, unit, range, required] = bending_stiffness_field;
  const std::string name = scene.materials[material].name + "_" + key, description = std::string("[") + unit + "]";
  const auto add = [&, range = range](const std::string& suffix, std::size_t first, std::size_t last) {
    numbers.push_back({name + suffix, description, range,
                       [=](const SceneDesc& s) { return s.materials[material].material.bending_stiffness[first]; },
                       [=](SceneDesc& s, double value) {
                         BendingStiffness& stiffness = s.materials[material].material.bending_stiffness;
                         stiffness[first] = stiffness[last] = value;
                       }});
  };
  if (scene.materials[material].material.bending_stiffness.is_isotropic()) return add("", 0, 1);
  add("_y", 0, 0);
  add("_z", 1, 1);
}

}  // namespace

std::vector<TunableNumber> tunable_numbers(const SceneDesc& scene) {
  std::vector<TunableNumber> numbers;
  // A center's attraction has a strength instead, which is not tuned.
  if (scene.gravity.type == GravityDesc::Type::uniform)
    add_vector("gravity", "[m/s^2]", &SceneDesc::gravity, &GravityDesc::acceleration, numbers);
  add_vector("wind", "[m/s] velocity of the fluid", &SceneDesc::fluid, &FluidDesc::velocity, numbers);
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    for (const auto& field : material_fields) {
      const auto member = field.member;
      if (std::find(std::begin(tunable_of_material), std::end(tunable_of_material), member) == std::end(tunable_of_material))
        continue;
      // What is inextensible stays so: lengths that are kept exactly cannot turn into springs at once, nor back.
      if (scene.materials[i].material.*member == infinity) continue;
      Range range = field.range;
      range.infinite = false;
      numbers.push_back({scene.materials[i].name + "_" + field.key, std::string("[") + field.unit + "]", range,
                         [i, member](const SceneDesc& s) { return s.materials[i].material.*member; },
                         [i, member](SceneDesc& s, double value) { s.materials[i].material.*member = value; }});
    }
    add_bending_stiffness(scene, i, numbers);
  }
  if (scene.contact)
    numbers.push_back({"contact_friction", "[] cable against cable", not_negative,
                       [](const SceneDesc& s) { return s.contact->friction; },
                       [](SceneDesc& s, double value) { s.contact->friction = value; }});
  return numbers;
}

namespace {

/// A number that is .inf in the scene, and so is not among those that are tuned.
bool is_infinite_in(const SceneDesc& scene, const std::string& name) {
  for (const NamedMaterial& named : scene.materials)
    for (const auto& field : material_fields)
      if (name == named.name + "_" + field.key && named.material.*field.member == infinity) return true;
  return false;
}

/// What the scene says against numbers that are right each by itself.
std::vector<std::string> conflicts(const SceneDesc& scene, const std::vector<NumberChange>& changes) {
  std::vector<std::string> errors = validate(scene);
  std::string tuned;
  for (const NumberChange& change : changes)
    tuned += (tuned.empty() ? "tuning." : ", tuning.") + change.name + ": " + number_text(change.value);
  for (std::string& error : errors) error = tuned + "; does not go with " + error;
  return errors;
}

/// Parameters that are named one by one.
constexpr std::size_t most_unknown = 100;

std::string names_of(const std::vector<TunableNumber>& numbers) {
  NameList names;
  for (const TunableNumber& number : numbers) names.add(number.name);
  return names.text();
}

}  // namespace

SceneDesc tuned_scene(SceneDesc scene, const std::vector<TunableNumber>& numbers, const std::vector<NumberChange>& changes,
                      std::vector<std::string> errors) {
  std::size_t unknown = 0;
  for (const NumberChange& change : changes) {
    const auto number = std::find_if(numbers.begin(), numbers.end(), [&](const auto& n) { return n.name == change.name; });
    if (number == numbers.end() && is_infinite_in(scene, change.name)) {
      errors.push_back(
          "tuning." + change.name + ": " + number_text(change.value) +
          "; allowed: .inf, which it is in the scene: what does not stretch, twist or yield there never does. A number "
          "in the scene can be tuned");
    } else if (number == numbers.end()) {
      if (++unknown <= most_unknown)
        errors.push_back("tuning: unknown parameter " + in_quotes(change.name) + "; allowed: " + names_of(numbers));
    } else if (!number->range.contains(change.value)) {
      errors.push_back("tuning." + number->name + ": " + number_text(change.value) + "; allowed: " + number->range.text());
    } else {
      number->set(scene, change.value);
    }
  }
  if (unknown > most_unknown) errors.push_back("tuning: " + std::to_string(unknown - most_unknown) + " more unknown parameters");
  if (errors.empty()) errors = conflicts(scene, changes);
  if (!errors.empty()) throw SceneError(std::move(errors));
  return scene;
}

}  // namespace verlet_cable

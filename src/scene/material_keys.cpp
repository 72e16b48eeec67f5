#include "material_keys.h"

#include <cmath>

#include "keys.h"
#include "verlet_cable/core/number_text.h"

namespace verlet_cable {
namespace {

/// A solid round section of an isotropic material.
struct ElasticModuli {
  double density = 0;         ///< [kg/m^3]
  double youngs_modulus = 0;  ///< [Pa]
  double poisson_ratio = 0;
};

constexpr std::array<Field<ElasticModuli>, 3> moduli_fields{{
    {"density", &ElasticModuli::density, "kg/m^3", positive, true},
    {"youngs_modulus", &ElasticModuli::youngs_modulus, "Pa", {1e-12, 1e15, "any number above 0"}, true},
    {"poisson_ratio", &ElasticModuli::poisson_ratio, "", {-0.999, 0.5, "a number above -1, at most 0.5"}, true},
}};

/// What the moduli replace.
const std::vector<std::string> replaced_keys{"linear_density", "axial_stiffness", "bending_stiffness", "torsional_stiffness"};

struct MaterialKeys {
  MaterialDesc material;
  ElasticModuli moduli;
};

constexpr const char* bending_stiffness_words = "one number, or two: about the material's y and z axes [N m^2]";

void read_bending_stiffness(const Value& value, MaterialKeys& keys) {
  BendingStiffness& stiffness = keys.material.bending_stiffness;
  if (value.node.IsSequence()) {
    const auto [y, z] = read_numbers<2>(value, bending_stiffness_words);
    stiffness = {y, z};
  } else {
    stiffness = read_number(value, bending_stiffness_field.range.text(bending_stiffness_field.unit) + ", or two");
  }
}

Keys<MaterialKeys> material_keys() {
  Keys<MaterialKeys> keys;
  const auto append = [&keys](const auto& fields, auto owner) {
    for (const auto& field : fields) {
      const auto key = field_key(field);
      // Which of the two sets of keys is required is for read_material to say.
      const bool required = key.name == "radius";
      keys.push_back({key.name, key.allowed, required,
                      [key, owner](const Value& value, MaterialKeys& target) { key.read(value, target.*owner); }});
    }
  };
  append(material_fields, &MaterialKeys::material);
  keys.push_back({bending_stiffness_field.key, bending_stiffness_words, false, read_bending_stiffness});
  append(moduli_fields, &MaterialKeys::moduli);
  return keys;
}

/// Linear density and stiffnesses of a solid round section (Timoshenko, Strength of Materials).
void apply(const ElasticModuli& moduli, MaterialDesc& material) {
  const double area = M_PI * material.radius * material.radius;
  const double second_moment = area * material.radius * material.radius / 4;
  const double shear_modulus = moduli.youngs_modulus / (2 * (1 + moduli.poisson_ratio));
  material.linear_density = moduli.density * area;
  material.axial_stiffness = moduli.youngs_modulus * area;
  material.bending_stiffness = moduli.youngs_modulus * second_moment;
  material.torsional_stiffness = shear_modulus * 2 * second_moment;
}

void read_moduli(const Value& value, const std::set<std::string>& given, MaterialKeys& keys) {
  bool good = true;
  const auto child_key = [&](const std::string& name) { return value.child(name, {}).key; };
  for (const auto& field : moduli_fields) {
    const double number = keys.moduli.*field.member;
    const bool is_given = given.count(field.key) > 0;
    if (is_given && field.range.contains(number)) continue;
    good = false;
    if (!is_given) {
      value.errors->add(child_key(field.key), "missing",
                        field.range.text(field.unit) + ", as the other elastic moduli are given");
    } else if (!std::isnan(number)) {
      value.errors->add(child_key(field.key), number_text(number), field.range.text(field.unit));
    }
  }
  for (const std::string& name : replaced_keys) {
    if (!given.count(name)) continue;
    value.errors->add(
        child_key(name), "given together with elastic moduli",
        "either linear_density, axial_stiffness, bending_stiffness and torsional_stiffness, or density, youngs_modulus and "
        "poisson_ratio");
    good = false;
  }
  if (good) {
    apply(keys.moduli, keys.material);
  } else {
    for (const std::string& name : replaced_keys) value.errors->mark(child_key(name));
  }
}

MaterialDesc read_material(const Value& value, const Keys<MaterialKeys>& table) {
  MaterialKeys keys;
  const std::set<std::string> given = read_map(value, table, keys);
  bool has_moduli = false;
  for (const auto& field : moduli_fields) has_moduli = has_moduli || given.count(field.key);
  if (has_moduli) {
    read_moduli(value, given, keys);
  } else if (value.node.IsMap() && !given.count("linear_density")) {
    value.errors->add_unread(
        value.child("linear_density", {}).key, "missing",
        material_fields[0].range.text(material_fields[0].unit) + ", or density, youngs_modulus and poisson_ratio");
  }
  return keys.material;
}

}  // namespace

std::vector<NamedMaterial> read_materials(const Value& value) {
  std::vector<NamedMaterial> materials;
  if (!value.node.IsMap()) {
    value.reject("a map of names to materials");
    return materials;
  }
  const Keys<MaterialKeys> table = material_keys();
  std::set<std::string> names;
  for (const auto& entry : value.node) {
    if (!entry.first.IsScalar()) {
      value.errors->add(value.key, "name " + value_text(entry.first), name_words);
      continue;
    }
    const std::string& name = entry.first.Scalar();
    const Value child = value.child(escaped(name), entry.second);
    if (!names.insert(name).second) {
      value.errors->add(child.key, "given twice", "each name once");
      continue;
    }
    materials.push_back({name, read_material(child, table)});
  }
  return materials;
}

}  // namespace verlet_cable

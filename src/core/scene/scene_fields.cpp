#include "verlet_cable/core/scene_fields.h"

#include <algorithm>

#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/quoted_text.h"

namespace verlet_cable {

bool is_name(const std::string& name) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const auto is_other = [&](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_'; };
  return !name.empty() && name.size() <= most_name_characters && is_letter(name[0]) &&
         std::all_of(name.begin(), name.end(), is_other);
}

bool is_frame_name(const std::string& name) {
  const auto is_printable = [](char c) { return static_cast<unsigned char>(c) > ' ' && c != '\x7f'; };
  return !name.empty() && name.size() <= most_name_characters && name[0] != '/' &&
         std::all_of(name.begin(), name.end(), is_printable);
}

bool has_dimension(ShapeType type, const std::string& key) {
  switch (type) {
    case ShapeType::plane:
      return false;
    case ShapeType::sphere:
      return key == "radius";
    case ShapeType::capsule:
    case ShapeType::cylinder:
      return key == "radius" || key == "length";
    case ShapeType::box:
      return key == "size";
    case ShapeType::mesh:
      break;
  }
  return key == "uri" || key == "scale" || key == "sheet" || key == "thickness";
}

std::string Range::text(const char* unit) const {
  const std::string unit_text = *unit ? " [" + std::string(unit) + "]" : "";
  return words + unit_text + " (from " + number_text(lowest) + " to " + number_text(highest) + ")";
}

std::string material_names(const std::vector<NamedMaterial>& materials) {
  constexpr std::size_t most = 20;
  if (materials.empty()) return "there are none";
  std::string names = escaped(materials[0].name);
  for (std::size_t i = 1; i < std::min(most, materials.size()); ++i) names += ", " + escaped(materials[i].name);
  return materials.size() > most ? names + ", ..." : names;
}

}  // namespace verlet_cable

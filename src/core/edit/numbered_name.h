#pragma once

#include <string>

#include "verlet_cable/core/scene_fields.h"

namespace verlet_cable {

/// `base` followed by the lowest number for which `taken` is false; the end of a long base gives way to the number.
template <typename Taken>
std::string numbered(const std::string& base, int first, const Taken& taken) {
  for (int i = first;; ++i) {
    const std::string number = std::to_string(i), name = base.substr(0, most_name_characters - number.size()) + number;
    if (!taken(name)) return name;
  }
}

}  // namespace verlet_cable

#pragma once

#include <string>

#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// Describes an excursion, for events.
inline std::string excursion_text(const Excursion& excursion) {
  if (excursion.kind == Excursion::Kind::bend)
    return "bends to a radius of " + rounded_text(excursion.value) + " m, below minimum_bend_radius, " +
           number_text(excursion.allowed) + " m";
  return "is pulled with " + rounded_text(excursion.value) + " N, above maximum_tension, " + number_text(excursion.allowed) +
         " N";
}

}  // namespace verlet_cable

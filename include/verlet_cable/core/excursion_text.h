#pragma once

#include <string>

#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/quoted_text.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// Describes an excursion, for events.
inline std::string excursion_text(const Excursion& excursion) {
  if (excursion.kind == Excursion::Kind::bend)
    return "bends to a radius of " + rounded_text(excursion.value) + " m, below minimum_bend_radius, " +
           number_text(excursion.allowed) + " m";
  if (excursion.kind == Excursion::Kind::squeeze)
    return "is squeezed by " + in_quotes(excursion.other) + " with " + rounded_text(excursion.value) +
           " N/m, above maximum_squeeze, " + number_text(excursion.allowed) + " N/m";
  return "is pulled with " + rounded_text(excursion.value) + " N, above maximum_tension, " + number_text(excursion.allowed) +
         " N";
}

}  // namespace verlet_cable

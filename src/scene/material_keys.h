#pragma once

#include <vector>

#include "value.h"

namespace verlet_cable {

/// Reads `materials`: a map of names to materials, each by linear density and stiffnesses, or by density and elastic moduli.
std::vector<NamedMaterial> read_materials(const Value& value);

}  // namespace verlet_cable

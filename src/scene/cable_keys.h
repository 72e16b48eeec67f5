#pragma once

#include "value.h"

namespace verlet_cable {

/// Reads one element of `cables`.
void read_cable(const Value& value, CableDesc& cable);

}  // namespace verlet_cable

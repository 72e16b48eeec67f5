#pragma once

#include <string>
#include <vector>

#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// Errors as one line of text.
std::string join(const std::vector<std::string>& errors);

/// The answer to a request that has errors.
EditResult refused(const std::vector<std::string>& errors);

}  // namespace verlet_cable

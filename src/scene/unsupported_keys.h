#pragma once

#include <string>

#include "value.h"

namespace verlet_cable {

/// Whether `key` (`cables[0].initial.type`, `nets`) belongs to the scene's schema but not to what is simulated yet.
bool is_unsupported_key(const std::string& key);

/// Adds an error for every value of the tree that asks for something that is not simulated yet.
void reject_unsupported(const Value& root);

}  // namespace verlet_cable

#pragma once

#include <string>

#include "verlet_cable/core/edit.h"

namespace verlet_cable {

inline EditResult done(const std::string& message) {
  return {true, message, {}};
}

inline EditResult refused(const std::string& message) {
  return {false, message, {}};
}

}  // namespace verlet_cable

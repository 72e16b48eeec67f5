#pragma once

#include <cstddef>
#include <string>
#include <system_error>

#include "verlet_cable/core/quoted_text.h"

namespace verlet_cable::tools {

/// What an errno means.
inline std::string error_text(int error) {
  return std::generic_category().message(error);
}

/// A path for messages: all of it, so that it can be found.
inline std::string quoted_path(const std::string& path) {
  constexpr std::size_t longest = 4096;
  return '"' + escaped(path, longest) + '"';
}

}  // namespace verlet_cable::tools

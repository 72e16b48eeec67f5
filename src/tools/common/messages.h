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

/// A path for messages: all of it, so that it can be found, on one line.
inline std::string path_text(const std::string& path) {
  constexpr std::size_t longest = 4096;
  return escaped(path, longest);
}
inline std::string quoted_path(const std::string& path) {
  return '"' + path_text(path) + '"';
}

}  // namespace verlet_cable::tools

#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>

namespace verlet_cable::fuzz {

/// Ends the process, as a finding, where something is not as it must be.
inline void require(bool is_so, const std::string& what) {
  if (is_so) return;
  std::fprintf(stderr, "not so: %s\n", what.c_str());
  std::abort();
}

}  // namespace verlet_cable::fuzz

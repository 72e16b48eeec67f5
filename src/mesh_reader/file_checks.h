#pragma once

#include <stdexcept>
#include <string>

namespace verlet_cable::mesh_reader {

/// Why a file is refused.
class Refused : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What can be known of a file of a format (stl, obj or dae) before Assimp sees it: that it is of that format, its number of
/// triangles, how deep it is nested. Throws Refused.
void check_file(const std::string& format, const std::string& content);

}  // namespace verlet_cable::mesh_reader

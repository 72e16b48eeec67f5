#include "file_checks.h"

#include <cstdint>
#include <cstring>

#include "scene/mesh_protocol.h"
#include "scene/xml_outline.h"

namespace verlet_cable::mesh_reader {
namespace {

constexpr std::size_t stl_header = 84;    ///< [byte]
constexpr std::size_t stl_triangle = 50;  ///< [byte]
constexpr std::size_t deepest_level = 256;

bool is_text(const std::string& content) {
  return content.find('\0') == std::string::npos;
}

void check_stl(const std::string& content) {
  if (content.size() >= stl_header) {
    std::uint32_t triangles;
    std::memcpy(&triangles, content.data() + stl_header - sizeof triangles, sizeof triangles);
    const std::uint64_t size = stl_header + stl_triangle * std::uint64_t{triangles};
    if (content.size() == size && triangles > mesh_protocol::most_triangles)
      throw Refused("it has " + std::to_string(triangles) + " triangles, more than " +
                    std::to_string(mesh_protocol::most_triangles));
    if (content.size() == size) return;
    if (!is_text(content))
      throw Refused("no mesh: an STL of " + std::to_string(content.size()) + " bytes, but the " + std::to_string(triangles) +
                    " triangles of its header take " + std::to_string(size));
  }
  const std::size_t start = content.find_first_not_of(" \t\r\n");
  if (start == std::string::npos || content.compare(start, 5, "solid") != 0 || !is_text(content))
    throw Refused("no mesh: neither binary STL nor text that starts with \"solid\"");
}

void check_dae(const std::string& content) {
  if (content.find("<COLLADA") == std::string::npos || !is_text(content))
    throw Refused("no mesh: a .dae without an element COLLADA");
  const std::size_t levels = outline_of(content).levels;
  if (levels > deepest_level)
    throw Refused("its elements are nested " + std::to_string(levels) + " levels deep, more than " +
                  std::to_string(deepest_level));
}

}  // namespace

void check_file(const std::string& format, const std::string& content) {
  if (content.empty()) throw Refused("no mesh: it is empty");
  if (format == "stl") {
    check_stl(content);
  } else if (format == "dae") {
    check_dae(content);
  } else if (!is_text(content)) {
    throw Refused("no mesh: an .obj that is no text");
  }
}

}  // namespace verlet_cable::mesh_reader

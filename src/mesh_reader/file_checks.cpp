#include "file_checks.h"

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>

#include "scene/mesh_protocol.h"
#include "scene/xml_outline.h"

namespace verlet_cable::mesh_reader {
namespace {

constexpr std::size_t stl_header = 84;    ///< [byte]
constexpr std::size_t stl_triangle = 50;  ///< [byte]
constexpr std::size_t deepest_level = 256;
constexpr std::size_t most_digits = 20;  // of a number in a message

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

/// Assimp does not get past what is no index.
void check_indices(const std::string& content, const std::string& element) {
  const std::string tag = "<" + element;
  for (std::size_t at = content.find(tag); at != std::string::npos; at = content.find(tag, at + 1)) {
    if (content.find_first_of(" \t\r\n/>", at + tag.size()) != at + tag.size()) continue;  // another element
    const std::size_t text = content.find('>', at) + 1;
    if (text == 0 || content[text - 2] == '/') continue;
    const std::size_t end = content.find_first_not_of("0123456789 \t\r\n", text);
    if (end == std::string::npos || content.compare(end, 2, "</") == 0) continue;
    throw Refused("no mesh: <" + element + "> at byte " + std::to_string(at) + " has other content than indices");
  }
}

/// Assimp takes memory for as many numbers as an attribute says, before it has seen one.
void check_counts(const std::string& content) {
  const std::string attribute = "count", between = " \t\r\n=\"'";
  for (std::size_t at = content.find(attribute); at != std::string::npos; at = content.find(attribute, at + 1)) {
    const std::size_t first = content.find_first_not_of(between, at + attribute.size());
    if (first == std::string::npos || first == at + attribute.size()) continue;
    const std::size_t last = content.find_first_not_of("0123456789", first);
    const std::string digits = content.substr(first, last == std::string::npos ? last : last - first);
    if (digits.size() < std::numeric_limits<std::size_t>::digits10 &&
        std::strtoull(digits.c_str(), nullptr, 10) <= content.size())
      continue;
    throw Refused("no mesh: count " + digits.substr(0, most_digits) + " at byte " + std::to_string(at) + ", in a file of " +
                  std::to_string(content.size()) + " bytes");
  }
}

void check_dae(const std::string& content) {
  if (content.find("<COLLADA") == std::string::npos || !is_text(content))
    throw Refused("no mesh: a .dae without an element COLLADA");
  const std::size_t levels = outline_of(content).levels;
  if (levels > deepest_level)
    throw Refused("its elements are nested " + std::to_string(levels) + " levels deep, more than " +
                  std::to_string(deepest_level));
  check_counts(content);
  for (const char* const element : {"p", "vcount"}) check_indices(content, element);
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

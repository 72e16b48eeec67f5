#include "file_checks.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <map>

#include "scene/mesh_protocol.h"
#include "scene/xml_outline.h"

namespace verlet_cable::mesh_reader {
namespace {

constexpr std::size_t stl_header = 84;    ///< [byte]
constexpr std::size_t stl_triangle = 50;  ///< [byte]
constexpr std::size_t deepest_level = 256;
constexpr std::size_t most_digits = 20;  // of a number in a message
constexpr const char* white = " \t\r\n";
constexpr const char* digits_and_white = "0123456789 \t\r\n";

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
  const std::size_t start = content.find_first_not_of(white);
  if (start == std::string::npos || content.compare(start, 5, "solid") != 0 || !is_text(content))
    throw Refused("no mesh: neither binary STL nor text that starts with \"solid\"");
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

/// The value of an attribute in a start tag; empty if there is none.
std::string attribute_of(const std::string& tag, const std::string& name) {
  for (std::size_t at = tag.find(name); at != std::string::npos; at = tag.find(name, at + 1)) {
    if (at == 0 || std::strchr(white, tag[at - 1]) == nullptr) continue;
    const std::size_t equals = tag.find_first_not_of(white, at + name.size());
    if (equals == std::string::npos || tag[equals] != '=') continue;
    const std::size_t quote = tag.find_first_not_of(white, equals + 1);
    if (quote == std::string::npos) return "";
    const std::size_t end = tag.find(tag[quote], quote + 1);
    return tag.substr(quote + 1, end == std::string::npos ? end : end - quote - 1);
  }
  return "";
}

/// A number of values, `otherwise` where none is given; NaN where it is no whole number.
double values_of(const std::string& tag, const std::string& name, double otherwise) {
  const std::string text = attribute_of(tag, name);
  if (text.empty()) return otherwise;
  return text.find_first_not_of(digits_and_white) == std::string::npos ? std::strtod(text.c_str(), nullptr) : std::nan("");
}

/// Calls `visit` for the start tags of an element, with the byte where each begins.
template <class Visitor>
void for_each_tag(const std::string& content, const std::string& element, const Visitor& visit) {
  for (std::size_t at = content.find('<' + element); at != std::string::npos; at = content.find('<' + element, at + 1))
    if (content.find_first_of(" \t\r\n/>", at) == at + 1 + element.size())
      visit(at, content.substr(at, content.find('>', at) - at));
}

/// Assimp does not get past what is no index.
void check_indices(const std::string& content, const std::string& element) {
  for_each_tag(content, element, [&](std::size_t at, const std::string& tag) {
    const std::size_t text = at + tag.size() + 1;
    if (text > content.size() || tag.back() == '/') return;
    const std::size_t end = content.find_first_not_of(digits_and_white, text);
    if (end == std::string::npos || content.compare(end, 2, "</") == 0) return;
    throw Refused("no mesh: <" + element + "> at byte " + std::to_string(at) + " has other content than indices");
  });
}

/// Assimp reads as many values as an accessor says, also where its array has fewer.
void check_accessors(const std::string& content) {
  std::map<std::string, double> sizes;
  for_each_tag(content, "float_array", [&](std::size_t, const std::string& tag) {
    const auto [array, is_new] = sizes.emplace('#' + attribute_of(tag, "id"), values_of(tag, "count", 0));
    if (!is_new) array->second = 0;  // two of one name: which one is read is not known
  });
  for_each_tag(content, "accessor", [&](std::size_t at, const std::string& tag) {
    const auto array = sizes.find(attribute_of(tag, "source"));
    const double count = values_of(tag, "count", 0);
    if (array == sizes.end() || count == 0) return;
    double parameters = 0;
    if (tag.back() != '/') {
      const std::string inside = content.substr(at, content.find("</accessor", at) - at);
      for_each_tag(inside, "param", [&](std::size_t, const std::string&) { ++parameters; });
    }
    const double stride = values_of(tag, "stride", 1);
    const double needed = values_of(tag, "offset", 0) + (count - 1) * stride + std::max(stride, parameters);
    if (!(needed <= array->second))
      throw Refused("no mesh: <accessor> at byte " + std::to_string(at) + " reads more values than its array has");
  });
}

void check_dae(const std::string& content) {
  if (content.find("<COLLADA") == std::string::npos || !is_text(content))
    throw Refused("no mesh: a .dae without an element COLLADA");
  const std::size_t levels = outline_of(content).levels;
  if (levels > deepest_level)
    throw Refused("its elements are nested " + std::to_string(levels) + " levels deep, more than " +
                  std::to_string(deepest_level));
  check_counts(content);
  check_accessors(content);
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

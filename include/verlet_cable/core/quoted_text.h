#pragma once

#include <cstddef>
#include <string>

namespace verlet_cable {

/// Text from a user, for messages: one line without control characters, truncated after about `longest` characters.
inline std::string escaped(const std::string& text, std::size_t longest = 60) {
  constexpr char hexadecimal[] = "0123456789abcdef";
  std::string result;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    // Characters of UTF-8 stay whole.
    const bool continues = (byte & 0xc0) == 0x80;
    if (result.size() >= longest && (!continues || result.size() >= longest + 3)) return result + "...";
    if (byte < 0x20 || byte == 0x7f) {
      result += {'\\', 'x', hexadecimal[byte / 16], hexadecimal[byte % 16]};
    } else {
      result += c;
    }
  }
  return result;
}

/// The same in quotes.
inline std::string quoted(const std::string& text) {
  return '"' + escaped(text) + '"';
}

}  // namespace verlet_cable

#pragma once

#include <charconv>
#include <cstddef>
#include <cstdio>
#include <string>

namespace verlet_cable {

/// Room that `write_number` needs.
constexpr std::size_t number_text_size = 32;

/// Writes a number so that reading it back gives the same double; the shortest such text where the standard library has it.
/// `buffer` has room for `number_text_size` characters. Returns the end of the text, which is not terminated.
inline char* write_number(char* buffer, double value) {
#if defined(__cpp_lib_to_chars)
  return std::to_chars(buffer, buffer + number_text_size, value).ptr;
#else
  return buffer + std::snprintf(buffer, number_text_size, "%.17g", value);
#endif
}

/// The same as a string.
inline std::string number_text(double value) {
  char buffer[number_text_size];
  return {buffer, write_number(buffer, value)};
}

}  // namespace verlet_cable

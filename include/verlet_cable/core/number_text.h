#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace verlet_cable {

/// Room that `write_number` needs.
constexpr std::size_t number_text_size = 32;

/// Writes a number so that reading it back gives the same double; the shortest such text where the standard library has it.
/// `buffer` has room for `number_text_size` characters. Returns the end of the text, which is not terminated. A NaN has no sign.
inline char* write_number(char* buffer, double value) {
  if (std::isnan(value)) return std::copy_n("nan", 3, buffer);
#if defined(__cpp_lib_to_chars)
  return std::to_chars(buffer, buffer + number_text_size, value).ptr;
#else
  return buffer + std::snprintf(buffer, number_text_size, "%.17g", value);
#endif
}

/// The same as a string. For what a user gave and sees again; what was measured or computed is `rounded_text`.
inline std::string number_text(double value) {
  char buffer[number_text_size];
  return {buffer, write_number(buffer, value)};
}

/// A number that was measured or computed, for people: rounded to so many significant digits, but to 1 at least below 1e9.
inline std::string rounded_text(double value, int digits = 4) {
  if (std::isnan(value)) return "nan";
  char buffer[number_text_size];
  const bool is_long = std::abs(value) >= std::pow(10.0, digits) && std::abs(value) < 1e9;
  std::snprintf(buffer, sizeof buffer, is_long ? "%.*f" : "%.*g", is_long ? 0 : digits, value);
  return buffer;
}

/// The same for a bound: 1 rounds up, so that a smallest allowed number is allowed as it is written, -1 rounds down.
inline std::string rounded_bound_text(double value, int direction, int digits = 4) {
  std::string text = rounded_text(value, digits);
  if (direction * (value - std::strtod(text.c_str(), nullptr)) <= 0 || !std::isfinite(value)) return text;
  const double last_digit = std::pow(10.0, std::floor(std::log10(std::abs(value))) - digits + 1);
  const double unit = std::abs(value) < 1e9 ? std::min(1.0, last_digit) : last_digit;
  return rounded_text(value + direction * 0.5 * unit, digits);
}

}  // namespace verlet_cable

#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <string>
#if !defined(__cpp_lib_to_chars)
#include <iomanip>
#include <locale>
#include <sstream>
#endif

namespace verlet_cable {

/// Size [characters] of the buffer that `write_number` needs.
constexpr std::size_t number_text_size = 32;

/// A number as printf writes it: with "%.*f" if `is_fixed`, which is allowed below 1e16 only, else with "%.*g". Independent of
/// the locale, which the program around the simulation may have set, the decimal point is a point.
inline std::string printed_text(double value, int digits, bool is_fixed = false) {
#if defined(__cpp_lib_to_chars)
  char buffer[number_text_size];
  const auto format = is_fixed ? std::chars_format::fixed : std::chars_format::general;
  return {buffer, std::to_chars(buffer, buffer + number_text_size, value, format, digits).ptr};
#else
  std::ostringstream text;
  text.imbue(std::locale::classic());
  if (is_fixed) text << std::fixed;
  text << std::setprecision(digits) << value;
  return text.str();
#endif
}

/// Writes a number so that reading it back gives the same double; the shortest such text if the standard library provides it.
/// `buffer` has room for `number_text_size` characters. Returns the end of the text, which is not terminated. A NaN has no sign.
inline char* write_number(char* buffer, double value) {
  if (std::isnan(value)) return std::copy_n("nan", 3, buffer);
#if defined(__cpp_lib_to_chars)
  return std::to_chars(buffer, buffer + number_text_size, value).ptr;
#else
  const std::string text = printed_text(value, 17);
  return std::copy(text.begin(), text.end(), buffer);
#endif
}

/// The same as a string. It is for numbers that a user gave; for measured or computed ones there is `rounded_text`.
inline std::string number_text(double value) {
  char buffer[number_text_size];
  return {buffer, write_number(buffer, value)};
}

/// A measured or computed number, rounded to `digits` significant digits, but below 1e9 not more coarsely than to an integer.
inline std::string rounded_text(double value, int digits = 4) {
  if (std::isnan(value)) return "nan";
  const bool is_long = std::abs(value) >= std::pow(10.0, digits) && std::abs(value) < 1e9;
  return printed_text(value, is_long ? 0 : digits, is_long);
}

/// The number in a text of these functions.
inline double number_of(const std::string& text) {
  double value = 0;
#if defined(__cpp_lib_to_chars)
  std::from_chars(text.data(), text.data() + text.size(), value);
#else
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  stream >> value;
#endif
  return value;
}

/// As `rounded_text`, for a bound: direction 1 rounds up, so that a lower bound is itself allowed as written; -1 rounds down.
inline std::string rounded_bound_text(double value, int direction, int digits = 4) {
  const std::string text = rounded_text(value, digits);
  if (!std::isfinite(value) || direction * (value - number_of(text)) <= 0) return text;
  const double last_digit = std::pow(10.0, std::floor(std::log10(std::abs(value))) - digits + 1);
  const double unit = std::abs(value) < 1e9 ? std::min(1.0, last_digit) : last_digit;
  return rounded_text(value + direction * 0.5 * unit, digits);
}

}  // namespace verlet_cable

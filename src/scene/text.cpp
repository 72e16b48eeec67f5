#include "text.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <locale>
#include <numeric>
#include <sstream>
#include <system_error>
#include <vector>

#include "verlet_cable/core/scene_desc.h"

namespace verlet_cable {
namespace {

constexpr std::size_t longest_name_compared = 64;

std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

bool is_decimal(const std::string& text) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  auto at = text.begin();
  const auto skip = [&](const char* any_of) {
    return at != text.end() && std::string(any_of).find(*at) != std::string::npos && (++at, true);
  };
  const auto digits = [&] {
    const auto first = at;
    at = std::find_if_not(at, text.end(), is_digit);
    return at - first;
  };
  skip("+-");
  auto mantissa = digits();
  if (skip(".")) mantissa += digits();
  if (mantissa == 0) return false;
  if (skip("eE")) {
    skip("+-");
    if (digits() == 0) return false;
  }
  return at == text.end();
}

}  // namespace

std::optional<double> parse_number(const std::string& text) {
  const std::string word = lower_case(text.substr(0, 10));
  if (text.size() < 10) {
    const bool negative = word.rfind('-', 0) == 0;
    const std::string unsigned_word = negative || word.rfind('+', 0) == 0 ? word.substr(1) : word;
    if (unsigned_word == ".inf" || unsigned_word == "inf" || unsigned_word == "infinity") return negative ? -infinity : infinity;
  }
  if (!is_decimal(text)) return std::nullopt;
#if defined(__cpp_lib_to_chars)
  // Much the faster; it does not say which of too large and too small a number is.
  double value = 0;
  const char* const begin = text.data() + (text[0] == '+' ? 1 : 0);
  if (std::from_chars(begin, text.data() + text.size(), value).ec == std::errc()) return value;
#endif
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  double number = 0;
  stream >> number;
  // Overflow is an error of the stream that leaves the largest number; underflow leaves something near zero, which is meant.
  if (stream.fail() && std::abs(number) > 1) return std::nullopt;
  return number;
}

std::size_t spelling_distance(const std::string& a, const std::string& b) {
  if (a.size() > longest_name_compared || b.size() > longest_name_compared) return longest_name_compared;
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

}  // namespace verlet_cable

#include "value.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <locale>
#include <numeric>
#include <sstream>
#include <vector>

namespace verlet_cable {
namespace {

constexpr std::size_t longest_text = 60;
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

void append_flow(const YAML::Node& node, int depth, std::string& text) {
  if (text.size() > longest_text) return;
  if (!node.IsDefined() || node.IsNull()) {
    text += "nothing";
  } else if (node.IsScalar()) {
    text += node.Scalar().size() > longest_text ? node.Scalar().substr(0, longest_text + 1) : node.Scalar();
  } else if (depth == 0) {
    text += "...";
  } else {
    text += node.IsSequence() ? '[' : '{';
    const char* separator = "";
    for (const auto& entry : node) {
      text += separator;
      separator = ", ";
      if (node.IsSequence()) {
        append_flow(entry, depth - 1, text);
      } else {
        append_flow(entry.first, depth - 1, text);
        text += ": ";
        append_flow(entry.second, depth - 1, text);
      }
      if (text.size() > longest_text) return;
    }
    text += node.IsSequence() ? ']' : '}';
  }
}

}  // namespace

void Value::reject(const std::string& allowed) const {
  errors->add_unread(key, value_text(node), allowed);
}

std::optional<double> parse_number(const std::string& text) {
  const std::string word = lower_case(text.substr(0, 10));
  if (text.size() < 10) {
    const bool negative = word.rfind('-', 0) == 0;
    const std::string unsigned_word = negative || word.rfind('+', 0) == 0 ? word.substr(1) : word;
    if (unsigned_word == ".inf" || unsigned_word == "inf" || unsigned_word == "infinity") return negative ? -infinity : infinity;
  }
  if (!is_decimal(text)) return std::nullopt;
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  double number = 0;
  stream >> number;
  // Overflow is an error of the stream that leaves the largest number; underflow leaves something near zero, which is meant.
  if (stream.fail() && std::abs(number) > 1) return std::nullopt;
  return number;
}

std::string escaped(const std::string& text) {
  constexpr char hexadecimal[] = "0123456789abcdef";
  std::string result;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool continues = (byte & 0xc0) == 0x80;
    if (result.size() >= longest_text && !continues) return result + "...";
    if (byte < 0x20 || byte == 0x7f) {
      result += {'\\', 'x', hexadecimal[byte / 16], hexadecimal[byte % 16]};
    } else {
      result += c;
    }
  }
  return result;
}

std::string quoted(const std::string& text) {
  return '"' + escaped(text) + '"';
}

std::string value_text(const YAML::Node& node) {
  if (node.IsDefined() && node.IsScalar()) {
    const std::string& text = node.Scalar();
    return is_decimal(text) || parse_number(text) ? escaped(text) : quoted(text);
  }
  std::string text;
  append_flow(node, 4, text);
  return escaped(text);
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

double read_number(const Value& value, const std::string& allowed) {
  if (value.node.IsScalar()) {
    if (const auto number = parse_number(value.node.Scalar())) return *number;
  }
  value.reject(allowed);
  return unread;
}

int read_integer(const Value& value, const std::string& allowed) {
  if (value.node.IsScalar()) {
    const auto number = parse_number(value.node.Scalar());
    if (number && *number == std::round(*number) && std::abs(*number) <= largest_integer) return static_cast<int>(*number);
  }
  value.reject(allowed);
  return 0;
}

std::string read_text(const Value& value, const std::string& allowed) {
  if (value.node.IsScalar()) return value.node.Scalar();
  value.reject(allowed);
  return {};
}

Vector3 read_vector(const Value& value, const char* unit) {
  const auto numbers = read_numbers<3>(value, std::string("three ") + coordinate.text(unit));
  return {numbers[0], numbers[1], numbers[2]};
}

}  // namespace verlet_cable

#pragma once

#include <yaml-cpp/yaml.h>

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>

#include "error_list.h"
#include "verlet_cable/core/scene_fields.h"

namespace verlet_cable {

/// A node of the tree with its full key, and where its errors go.
struct Value {
  YAML::Node node;
  std::string key;
  ErrorList* errors;

  Value child(const std::string& name, const YAML::Node& child_node) const {
    return {child_node, key.empty() ? name : key + "." + name, errors};
  }
  Value element(std::size_t index, const YAML::Node& element_node) const {
    return {element_node, key + "[" + std::to_string(index) + "]", errors};
  }
  void reject(const std::string& allowed) const;  ///< adds the error `key: value; allowed: ...`
};

/// What stands for a number that could not be read: nothing is derived from it.
constexpr double unread = std::numeric_limits<double>::quiet_NaN();

/// The number that a text is: decimal, with or without exponent, or [+-][.]inf[inity] in any case. None for NaN, hexadecimal and
/// numbers that a double cannot hold.
std::optional<double> parse_number(const std::string& text);

/// A value for messages: one line, at most about 60 characters, control characters escaped.
std::string value_text(const YAML::Node& node);
/// A text for messages, likewise; `quoted` with quotes.
std::string escaped(const std::string& text);
std::string quoted(const std::string& text);

/// The one of `known` that is spelled most alike, empty if none is near.
template <class Names>
std::string nearest_name(const std::string& name, const Names& known);
std::size_t spelling_distance(const std::string& a, const std::string& b);

/// Readers of single values. What does not have the type is rejected with `allowed` and gives `unread`, 0 or an empty text.
double read_number(const Value& value, const std::string& allowed);
int read_integer(const Value& value, const std::string& allowed);
std::string read_text(const Value& value, const std::string& allowed);

/// N numbers; all of them `unread` where one could not be read.
template <std::size_t N>
std::array<double, N> read_numbers(const Value& value, const std::string& allowed) {
  std::array<double, N> numbers;
  bool good = value.node.IsSequence() && value.node.size() == N;
  if (good) {
    std::size_t i = 0;
    for (const auto& element : value.node) {
      const std::optional<double> number = element.IsScalar() ? parse_number(element.Scalar()) : std::nullopt;
      good = good && number;
      numbers[i++] = number.value_or(unread);
    }
  }
  if (good) return numbers;
  value.reject(allowed);
  numbers.fill(unread);
  return numbers;
}

Vector3 read_vector(const Value& value, const char* unit);

template <class Names>
std::string nearest_name(const std::string& name, const Names& known) {
  std::string nearest;
  std::size_t least = 1 + name.size() / 3;
  for (const std::string& candidate : known) {
    const std::size_t distance = spelling_distance(name, candidate);
    if (distance > least || (distance == least && !nearest.empty())) continue;
    nearest = candidate;
    least = distance;
  }
  return nearest;
}

}  // namespace verlet_cable

#pragma once

#include <yaml-cpp/yaml.h>

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>

#include "error_list.h"
#include "text.h"
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

/// A value for messages: one line, at most about 60 characters, control characters escaped.
std::string value_text(const YAML::Node& node);
/// Readers of single values. What does not have the type is rejected with `allowed` and gives `unread`, 0 or an empty text.
double read_number(const Value& value, const std::string& allowed);
int read_integer(const Value& value, const std::string& allowed);
std::string read_text(const Value& value, const std::string& allowed);

/// The N numbers of a list of N numbers.
template <std::size_t N>
std::optional<std::array<double, N>> numbers_of(const YAML::Node& node) {
  if (!node.IsSequence() || node.size() != N) return std::nullopt;
  std::array<double, N> numbers;
  std::size_t i = 0;
  for (const auto& element : node) {
    const std::optional<double> number = element.IsScalar() ? parse_number(element.Scalar()) : std::nullopt;
    if (!number) return std::nullopt;
    numbers[i++] = *number;
  }
  return numbers;
}

/// N numbers; all of them `unread` where one could not be read.
template <std::size_t N>
std::array<double, N> read_numbers(const Value& value, const std::string& allowed) {
  if (const auto numbers = numbers_of<N>(value.node)) return *numbers;
  value.reject(allowed);
  std::array<double, N> numbers;
  numbers.fill(unread);
  return numbers;
}

Vector3 read_vector(const Value& value, const char* unit);

}  // namespace verlet_cable

#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/quoted_text.h"
#include "verlet_cable/core/scene_fields.h"

namespace verlet_cable {

/// Lines of the form `key: value; allowed: what`.
class Errors {
 public:
  void add(const std::string& key, const std::string& value, const std::string& allowed) {
    lines_.push_back(key + ": " + value + "; allowed: " + allowed);
  }
  std::size_t size() const { return lines_.size(); }
  std::vector<std::string> take() { return std::move(lines_); }

 private:
  std::vector<std::string> lines_;
};

inline std::string indexed(const std::string& key, std::size_t index) {
  return key + "[" + std::to_string(index) + "]";
}

template <class Numbers>
std::string list_text(const Numbers& numbers) {
  std::string text;
  for (const double number : numbers) text += (text.empty() ? "" : ", ") + number_text(number);
  return "[" + text + "]";
}

inline std::string list_text(const Vector3& v) {
  return list_text(std::array<double, 3>{v.x(), v.y(), v.z()});
}

template <class Fields, class Owner>
void check_fields(const std::string& prefix, const Fields& fields, const Owner& owner, Errors& errors) {
  for (const auto& field : fields) {
    const double value = static_cast<double>(owner.*field.member);
    if (!field.range.contains(value)) errors.add(prefix + field.key, number_text(value), field.range.text(field.unit));
  }
}

template <class Numbers>
void check_numbers(const std::string& key, const Numbers& numbers, const Range& range, const char* unit, Errors& errors) {
  const bool good = std::all_of(numbers.begin(), numbers.end(), [&](double number) { return range.contains(number); });
  if (!good) errors.add(key, list_text(numbers), range.text(unit));
}

inline void check_vector(const std::string& key, const Vector3& v, const char* unit, Errors& errors) {
  check_numbers(key, std::array<double, 3>{v.x(), v.y(), v.z()}, coordinate, unit, errors);
}

inline bool has_sound_size(const CableDesc& cable) {
  return cable_fields[0].range.contains(cable.length) && cable_integer_fields[0].range.contains(cable.segments);
}

/// Names of one kind, each once in the scene.
class UniqueNames {
 public:
  void check(const std::string& key, const std::string& name, Errors& errors) {
    if (!is_name(name)) return errors.add(key, in_quotes(name), name_words);
    claim(key, name, errors);
  }
  /// Of any letters.
  void claim(const std::string& key, const std::string& name, Errors& errors) {
    const auto [first, is_new] = first_use_.emplace(name, key);
    if (!is_new) errors.add(key, in_quotes(name), "a name that is used once; it is " + first->second + " already");
  }

 private:
  std::map<std::string, std::string> first_use_;
};

}  // namespace verlet_cable

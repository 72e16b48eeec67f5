#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "value.h"

namespace verlet_cable {

/// A key of a map, whatever the map describes.
struct KeyName {
  std::string name;
  std::string allowed;  ///< for messages
  bool required;
};

/// A key of a map and how its value gets into `Target`.
template <class Target>
struct Key : KeyName {
  std::function<void(const Value&, Target&)> read;
};
template <class Target>
using Keys = std::vector<Key<Target>>;

/// Enumerators and their texts.
template <class Enumeration>
using Choices = std::vector<std::pair<std::string, Enumeration>>;

inline void read_field(const Value& value, double& target, const std::string& allowed) {
  target = read_number(value, allowed);
}
inline void read_field(const Value& value, int& target, const std::string& allowed) {
  target = read_integer(value, allowed);
}

inline void read_field(const Value& value, Vector3& target, const std::string& allowed) {
  const std::array<double, 3> numbers = read_numbers<3>(value, allowed);
  target = {numbers[0], numbers[1], numbers[2]};
}

/// The key of a field of the scene's tables.
template <class Owner, class Number>
Key<Owner> field_key(const Field<Owner, Number>& field) {
  const std::string allowed = field.range.text(field.unit);
  return {field.key, allowed, field.required,
          [member = field.member, allowed](const Value& value, Owner& owner) { read_field(value, owner.*member, allowed); }};
}

template <class Owner, class Table>
void append_fields(Keys<Owner>& keys, const Table& table) {
  for (const auto& field : table) keys.push_back(field_key(field));
}

/// The keys of what `Target` derives from.
template <class Target, class Base>
void append_keys(Keys<Target>& keys, const Keys<Base>& base) {
  for (const Key<Base>& key : base) keys.push_back({key.name, key.allowed, key.required, key.read});
}

template <class Owner, class Enumeration>
Key<Owner> choice_key(const std::string& name, Enumeration Owner::*member,
                      const Choices<std::common_type_t<Enumeration>>& choices, bool required = false) {
  std::string allowed;
  for (const auto& choice : choices) allowed += (allowed.empty() ? "" : " | ") + choice.first;
  return {name, allowed, required, [=](const Value& value, Owner& owner) {
            if (value.node.IsScalar()) {
              for (const auto& choice : choices) {
                if (choice.first != value.node.Scalar()) continue;
                owner.*member = choice.second;
                return;
              }
            }
            value.reject(allowed);
          }};
}

template <class Owner>
Key<Owner> switch_key(const std::string& name, bool Owner::*member) {
  return {name, "true | false", false, [=](const Value& value, Owner& owner) {
            const std::string text = value.node.IsScalar() ? value.node.Scalar() : "";
            if (text != "true" && text != "false") return value.reject("true | false");
            owner.*member = text == "true";
          }};
}

template <class Owner>
Key<Owner> text_key(const std::string& name, std::string Owner::*member, const std::string& allowed, bool required = false) {
  return {name, allowed, required, [=](const Value& value, Owner& owner) { owner.*member = read_text(value, allowed); }};
}

template <class Owner>
Key<Owner> vector_key(const std::string& name, Vector3 Owner::*member, const char* unit) {
  return {name, "three numbers", false, [=](const Value& value, Owner& owner) { owner.*member = read_vector(value, unit); }};
}

/// Calls `read` with the index in `keys` and the value of each key that is there: unknown, doubled and missing keys are errors.
/// Returns the names of the keys that are there.
std::set<std::string> read_keys(const Value& value, const std::vector<const KeyName*>& keys,
                                const std::function<void(std::size_t, const Value&)>& read);

/// Reads a map by its keys, as read_keys() does.
template <class Target>
std::set<std::string> read_map(const Value& value, const Keys<Target>& keys, Target& target) {
  std::vector<const KeyName*> names;
  for (const Key<Target>& key : keys) names.push_back(&key);
  return read_keys(value, names, [&](std::size_t key, const Value& child) { keys[key].read(child, target); });
}

/// Reads a list of maps. An element that is no map is an error and a default element, so that indices stay what they are in the
/// text.
template <class Element>
std::vector<Element> read_list(const Value& value, const std::function<void(const Value&, Element&)>& read) {
  std::vector<Element> elements;
  if (!value.node.IsSequence()) {
    value.reject("a list");
    return elements;
  }
  for (const auto& node : value.node) {
    const Value element = value.element(elements.size(), node);
    read(element, elements.emplace_back());
  }
  return elements;
}

}  // namespace verlet_cable

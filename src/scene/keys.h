#pragma once

#include <cstddef>
#include <functional>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "value.h"

namespace verlet_cable {

/// A key of a map and how its value gets into `Target`.
template <class Target>
struct Key {
  std::string name;
  std::string allowed;  ///< for messages
  bool required;
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
Key<Owner> text_key(const std::string& name, std::string Owner::*member, const std::string& allowed, bool required = false) {
  return {name, allowed, required, [=](const Value& value, Owner& owner) { owner.*member = read_text(value, allowed); }};
}

template <class Owner>
Key<Owner> vector_key(const std::string& name, Vector3 Owner::*member, const char* unit) {
  return {name, "three numbers", false, [=](const Value& value, Owner& owner) { owner.*member = read_vector(value, unit); }};
}

/// Reads a map by its keys: unknown, doubled and missing keys are errors. Returns the names of the keys that are there.
template <class Target>
std::set<std::string> read_map(const Value& value, const Keys<Target>& keys, Target& target) {
  std::vector<std::string> names;
  std::string all_names;
  for (const Key<Target>& key : keys) {
    names.push_back(key.name);
    all_names += (all_names.empty() ? "" : ", ") + key.name;
  }
  std::set<std::string> seen;
  if (!value.node.IsMap()) {
    value.reject("a map of " + all_names);
    return seen;
  }
  for (const auto& entry : value.node) {
    if (!entry.first.IsScalar()) {
      value.errors->add(value.key.empty() ? "scene" : value.key, "key " + value_text(entry.first), all_names);
      continue;
    }
    const std::string& name = entry.first.Scalar();
    const Value child = value.child(escaped(name), entry.second);
    if (!seen.insert(name).second) {
      child.errors->add(child.key, "given twice, again as " + value_text(entry.second), "each key once");
      continue;
    }
    bool known = false;
    for (const Key<Target>& key : keys) {
      if (key.name != name) continue;
      key.read(child, target);
      known = true;
    }
    if (known) continue;
    const std::string nearest = nearest_name(name, names);
    child.errors->add(
        child.key,
        "unknown key, its value is " + value_text(entry.second) + (nearest.empty() ? "" : " (did you mean " + nearest + "?)"),
        all_names);
  }
  for (const Key<Target>& key : keys) {
    if (key.required && !seen.count(key.name)) value.errors->add_unread(value.child(key.name, {}).key, "missing", key.allowed);
  }
  return seen;
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

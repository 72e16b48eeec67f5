#include "keys.h"

#include <algorithm>

namespace verlet_cable {

std::set<std::string> read_keys(const Value& value, const std::vector<const KeyName*>& keys,
                                const std::function<void(std::size_t, const Value&)>& read) {
  std::vector<std::string> names;
  std::string all_names;
  for (const KeyName* key : keys) {
    names.push_back(key->name);
    all_names += (all_names.empty() ? "" : ", ") + key->name;
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
    for (std::size_t i = 0; i < keys.size(); ++i) {
      if (keys[i]->name != name) continue;
      read(i, child);
      known = true;
    }
    if (known) continue;
    // In brackets, `key:value` is a key.
    const std::size_t colon = name.find(':');
    const bool lacks_space = std::find(names.begin(), names.end(), name.substr(0, colon)) != names.end();
    const std::string meant =
        lacks_space ? escaped(name.substr(0, colon)) + ": " + escaped(name.substr(colon + 1)) : nearest_name(name, names);
    child.errors->add(
        child.key,
        "unknown key, its value is " + value_text(entry.second) + (meant.empty() ? "" : " (did you mean " + meant + "?)"),
        all_names);
  }
  for (const KeyName* key : keys) {
    if (key->required && !seen.count(key->name))
      value.errors->add_unread(value.child(key->name, {}).key, "missing", key->allowed);
  }
  return seen;
}

}  // namespace verlet_cable

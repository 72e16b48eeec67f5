#include "unsupported_keys.h"

#include <algorithm>
#include <vector>

namespace verlet_cable {
namespace {

/// Which values of a key pass.
enum class Passes { none, only, all_but };

/// `*` stands for any name, `[]` for any element of a list.
struct UnsupportedKey {
  const char* key;
  Passes passes;
  const char* value;
};

/// Keys of the schema whose values ask for something that is not simulated yet. A value that changes nothing passes.
constexpr UnsupportedKey unsupported_keys[] = {
    {"gravity.type", Passes::none, ""},
    {"particles", Passes::only, "[]"},
    {"nets", Passes::only, "[]"},
    {"integrator", Passes::only, "verlet"},
};

/// `cables[12].initial` -> cables, [12], initial
std::vector<std::string> parts_of(const std::string& key) {
  std::vector<std::string> parts(1);
  for (const char c : key) {
    if (c == '.' || c == '[') parts.emplace_back();
    if (c != '.') parts.back() += c;
  }
  return parts;
}

bool part_matches(const std::string& part, const std::string& pattern) {
  return pattern == "*" || pattern == part || (pattern == "[]" && part[0] == '[');
}

bool matches(const std::string& key, const std::string& pattern) {
  const std::vector<std::string> key_parts = parts_of(key);
  const std::vector<std::string> pattern_parts = parts_of(pattern);
  return std::equal(key_parts.begin(), key_parts.end(), pattern_parts.begin(), pattern_parts.end(), part_matches);
}

bool has_value(const YAML::Node& node, const std::string& value) {
  if (value == "[]") return node.IsSequence() && node.size() == 0;
  if (!node.IsScalar()) return false;
  const auto number = parse_number(value);
  return number ? parse_number(node.Scalar()) == number : node.Scalar() == value;
}

void reject(const UnsupportedKey& unsupported, const Value& value) {
  if (value.errors->is_unread(value.key)) return;
  const bool is_value = has_value(value.node, unsupported.value);
  if (unsupported.passes == Passes::only ? is_value : unsupported.passes == Passes::all_but && !is_value) return;
  const std::string named = std::string("only ") + (*unsupported.value ? unsupported.value : "\"\"");
  value.errors->add(value.key, value_text(value.node) + " is not supported yet",
                    unsupported.passes == Passes::only   ? named
                    : unsupported.passes == Passes::none ? "not to give this key"
                                                         : "the other values");
}

/// Visits the values whose keys match the pattern's parts from `at` on.
void visit(const UnsupportedKey& unsupported, const std::vector<std::string>& pattern, std::size_t at, const Value& value) {
  if (at == pattern.size()) return reject(unsupported, value);
  if (pattern[at] == "[]") {
    if (!value.node.IsSequence()) return;
    std::size_t index = 0;
    for (const auto& element : value.node) visit(unsupported, pattern, at + 1, value.element(index++, element));
  } else if (value.node.IsMap()) {
    for (const auto& entry : value.node) {
      if (!entry.first.IsScalar() || !part_matches(entry.first.Scalar(), pattern[at])) continue;
      visit(unsupported, pattern, at + 1, value.child(escaped(entry.first.Scalar()), entry.second));
    }
  }
}

}  // namespace

bool is_unsupported_key(const std::string& key) {
  return std::any_of(std::begin(unsupported_keys), std::end(unsupported_keys),
                     [&](const UnsupportedKey& unsupported) { return matches(key, unsupported.key); });
}

void reject_unsupported(const Value& root) {
  for (const UnsupportedKey& unsupported : unsupported_keys) visit(unsupported, parts_of(unsupported.key), 0, root);
}

}  // namespace verlet_cable

#include "value.h"

#include <cmath>

#include "verlet_cable/scene/scene_reader.h"

namespace verlet_cable {
namespace {

constexpr std::size_t longest_text = 60;

void append_flow(const YAML::Node& node, int depth, std::string& text) {
  if (text.size() > longest_text) return;
  if (!node.IsDefined() || node.IsNull()) {
    text += node.IsDefined() && !node.Tag().empty() ? node.Tag() : "nothing";
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

std::string value_text(const YAML::Node& node) {
  if (node.IsDefined() && node.IsScalar()) {
    const std::string& text = node.Scalar();
    return parse_number(text) ? escaped(text) : in_quotes(text);
  }
  std::string text;
  append_flow(node, 4, text);
  return escaped(text);
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
  if (value.node.IsScalar() && value.node.Tag() != boolean_tag) return value.node.Scalar();
  value.reject(allowed);
  return {};
}

Vector3 read_vector(const Value& value, const char* unit) {
  if (const auto numbers = numbers_of<3>(value.node)) return {(*numbers)[0], (*numbers)[1], (*numbers)[2]};
  value.reject(std::string("three ") + coordinate.text(unit));
  return Vector3::Constant(unread);
}

}  // namespace verlet_cable

#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "verlet_cable/core/number_text.h"

namespace verlet_cable::view {

/// Collects what is wrong: name, value, and what is allowed.
class ErrorLines {
 public:
  void require(bool is_good, const std::string& name, const std::string& value, const std::string& allowed) {
    if (!is_good) lines_.push_back(name + ": " + value + "; allowed: " + allowed);
  }
  const std::vector<std::string>& lines() const { return lines_; }

 private:
  std::vector<std::string> lines_;
};

/// `[1, 2, 3]`
template <class Numbers>
std::string list_text(const Numbers& numbers) {
  std::string text = "[";
  for (const double number : numbers) text += (text.size() > 1 ? ", " : "") + number_text(number);
  return text + "]";
}

/// Throws std::invalid_argument with all lines, if there are any.
inline void throw_errors(const std::vector<std::string>& lines) {
  if (lines.empty()) return;
  std::string text;
  for (const std::string& line : lines) text += (text.empty() ? "" : "\n") + line;
  throw std::invalid_argument(text);
}

}  // namespace verlet_cable::view

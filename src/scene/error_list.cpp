#include "error_list.h"

#include <utility>

namespace verlet_cable {
namespace {

constexpr std::size_t most_lines = 500;

}  // namespace

void ErrorList::add(const std::string& key, const std::string& what, const std::string& allowed) {
  add_line(key + ": " + what + "; allowed: " + allowed);
}

void ErrorList::add_unread(const std::string& key, const std::string& what, const std::string& allowed) {
  mark(key);
  add(key, what, allowed);
}

void ErrorList::add_validation(const std::vector<std::string>& lines) {
  for (const std::string& line : lines) {
    if (!is_unread(line.substr(0, line.find(": ")))) add_line(line);
  }
}

std::vector<std::string> ErrorList::take() {
  if (dropped_ > 0) lines_.push_back("and " + std::to_string(dropped_) + " more errors");
  return std::move(lines_);
}

bool ErrorList::is_unread(std::string key) const {
  while (!unread_keys_.count(key)) {
    const std::size_t end = key.find_last_of(".[");
    if (end == std::string::npos) return false;
    key.erase(end);
  }
  return true;
}

void ErrorList::add_line(const std::string& line) {
  if (lines_.size() < most_lines) {
    lines_.push_back(line);
  } else {
    ++dropped_;
  }
}

}  // namespace verlet_cable

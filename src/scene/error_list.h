#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <vector>

namespace verlet_cable {

/// Errors of a scene in the order they are found: lines that start with the full key. Keeps the first 500 and counts the others.
class ErrorList {
 public:
  /// `key: what; allowed: allowed`
  void add(const std::string& key, const std::string& what, const std::string& allowed);
  /// The same where nothing could be read for `key`: `validate` has nothing to say about it.
  void add_unread(const std::string& key, const std::string& what, const std::string& allowed);
  /// Says that nothing could be read for `key`, for a reason that was added under another key.
  void mark(const std::string& key) { unread_keys_.insert(key); }
  /// Adds lines of `validate`, but for those about a key that could not be read, or something inside it.
  void add_validation(const std::vector<std::string>& lines);

  bool empty() const { return lines_.empty(); }
  std::vector<std::string> take();

  /// Whether nothing could be read for `key`, or for something that it is inside of.
  bool is_unread(std::string key) const;

 private:
  void add_line(const std::string& line);

  std::vector<std::string> lines_;
  std::size_t dropped_ = 0;
  std::set<std::string> unread_keys_;
};

}  // namespace verlet_cable

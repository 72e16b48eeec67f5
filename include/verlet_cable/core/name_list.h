#pragma once

#include <cstddef>
#include <string>

#include "verlet_cable/core/quoted_text.h"

namespace verlet_cable {

/// A list of names for a message, of limited length: the first 20, and how many more there are.
class NameList {
 public:
  NameList() = default;
  template <class Names>
  explicit NameList(const Names& names) {
    for (const auto& name : names) add(name);
  }
  void add(const std::string& name) {
    if (++count_ <= most) text_ += (text_.empty() ? "" : ", ") + escaped(name);
  }
  /// `none`: the text if there are no names.
  std::string text(const std::string& none = "none") const {
    if (count_ == 0) return none;
    return count_ <= most ? text_ : text_ + " and " + std::to_string(count_ - most) + " more";
  }

 private:
  static constexpr std::size_t most = 20;

  std::string text_;
  std::size_t count_ = 0;
};

}  // namespace verlet_cable

#pragma once

#include <string>

#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/scene_fields.h"
#include "world/implementation.h"

namespace verlet_cable {

/// What is wrong with an edit, a line each.
class Problems {
 public:
  /// `names`: whether an edit has several things, which are named.
  explicit Problems(bool names = false) : names_(names) {}

  /// What comes next is wrong with the thing of that name.
  void of(const std::string& name) { prefix_ = names_ ? name + "." : ""; }
  void add(const std::string& text) { add_line(prefix_ + text); }
  void require(bool holds, const std::string& field, double value, const std::string& allowed) {
    if (!holds) add(field + ": " + number_text(value) + "; " + allowed);
  }
  void check_vector(const std::string& field, const Vector3& vector) {
    const std::string problem = vector_problem(prefix_ + field, vector, coordinate, "");
    if (!problem.empty()) add_line(problem);
  }
  const std::string& text() const { return text_; }  ///< empty if there is nothing

 private:
  void add_line(const std::string& line) { text_ += (text_.empty() ? "" : "\n") + line; }

  bool names_;
  std::string prefix_, text_;
};

}  // namespace verlet_cable

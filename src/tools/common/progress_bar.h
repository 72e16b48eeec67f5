#pragma once

#include <chrono>

namespace verlet_cable::tools {

/// A bar on standard error, if that is a terminal, and no data goes to one; otherwise nothing.
class ProgressBar {
 public:
  /// `amount` of what is to be done, counted in `unit`; without one a time [s]. `has_data`: standard output is for data.
  explicit ProgressBar(double amount, const char* unit = nullptr, bool has_data = false);
  ~ProgressBar() { clear(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// `done`: of the amount, so far.
  void show(double done, std::chrono::steady_clock::time_point now);
  /// Makes room for a line of text.
  void clear();

 private:
  bool is_on_;
  bool is_visible_ = false;
  double amount_;
  const char* unit_;  ///< null: it is a time
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point last_;
};

}  // namespace verlet_cable::tools

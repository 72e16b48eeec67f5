#pragma once

#include <chrono>

namespace verlet_cable::cable_sim {

/// A bar on standard error, if that is a terminal; otherwise nothing.
class ProgressBar {
 public:
  explicit ProgressBar(double duration);  ///< [s] to be simulated
  ~ProgressBar() { clear(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// `time`: [s] simulated so far.
  void show(double time, std::chrono::steady_clock::time_point now);
  /// Makes room for a line of text.
  void clear();

 private:
  bool is_on_;
  bool is_visible_ = false;
  double duration_;
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point last_;
};

}  // namespace verlet_cable::cable_sim

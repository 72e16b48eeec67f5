#pragma once

#include <string>
#include <vector>

namespace verlet_cable::bench {

/// Collects what was measured against what was to be reached, and prints tables as plain text.
class Report {
 public:
  /// Begins a table; the columns are as wide as their headings need.
  void table(const std::string& title, std::vector<std::string> columns);
  void row(const std::vector<std::string>& cells);
  void note(const std::string& line);
  /// "reached" or "MISSED", for a cell; counted.
  std::string at_least(double value, double target);
  std::string at_most(double value, double target);
  void summary() const;

 private:
  std::string judge(bool reached);

  std::string title_;
  std::vector<std::string> columns_;
  std::vector<std::size_t> widths_;
  int reached_ = 0;
  std::vector<std::string> missed_;  ///< titles of the tables
};

/// A number with so many significant digits.
std::string figure(double value, int digits = 3);

}  // namespace verlet_cable::bench

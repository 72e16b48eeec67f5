#pragma once

#include <cstddef>
#include <istream>
#include <string>
#include <vector>

namespace verlet_cable {

/// The lines of a CSV file, without empty ones, blanks at their ends and a byte order mark. Ends where the stream does, and where
/// a stream has no end: at a line that is too long, and after too many.
class CsvLines {
 public:
  CsvLines(std::istream& stream, std::size_t longest) : stream_(stream), buffer_(longest + 1) {}

  /// False when there is no other line, or none that is allowed: see `problem`.
  bool next(std::string& line);

  /// Of the line that was read last, from 1.
  std::size_t number() const { return number_; }

  /// What is wrong with that line, and what is allowed; empty where nothing is.
  const std::string& problem() const { return problem_; }
  const std::string& allowed() const { return allowed_; }

 private:
  std::istream& stream_;
  std::vector<char> buffer_;
  std::size_t number_ = 0;
  std::string problem_, allowed_;
};

/// What stands between the commas of a line, without blanks at its ends. Quotes mean nothing.
std::vector<std::string> csv_cells(const std::string& line);

}  // namespace verlet_cable

#pragma once

#include <fstream>
#include <istream>
#include <string>
#include <vector>

#include "csv_lines.h"

namespace verlet_cable {

/// A file to read. Throws SceneError if it cannot be.
std::ifstream open_file(const std::string& path);

/// The rows of a CSV file below its header, and all that is wrong with them, up to a hundred errors, each with its line.
class CsvRows {
 public:
  using Cells = std::vector<std::string>;

  CsvRows(std::istream& stream, const char* header);

  /// Calls `add_row(cells)` for each row that has as many cells as the header. Throws SceneError if there were errors.
  template <class AddRow>
  void read(const AddRow& add_row) {
    Cells cells;
    while (next(cells)) add_row(cells);
    throw_errors();
  }
  void add_error(const std::string& what, const std::string& allowed);
  std::size_t errors() const { return errors_.size(); }
  std::size_t line() const { return lines_.number(); }  ///< of the present row, from 1

 private:
  bool next(Cells& cells);
  void read_header();
  void throw_errors();

  CsvLines lines_;
  std::string header_;
  std::size_t columns_ = 0;
  bool begun_ = false;
  std::vector<std::string> errors_;
};

}  // namespace verlet_cable

#include "csv_lines.h"

namespace verlet_cable {
namespace {

constexpr std::size_t most_csv_lines = 10'000'001;  // a header and ten million rows

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

}  // namespace

bool CsvLines::next(std::string& line) {
  while (stream_.getline(buffer_.data(), static_cast<std::streamsize>(buffer_.size()))) {
    if (++number_ > most_csv_lines) {
      problem_ = "too many lines";
      allowed_ = "at most " + std::to_string(most_csv_lines);
      return false;
    }
    // The end of the line counts, but for a last line that has none.
    const auto size = static_cast<std::size_t>(stream_.gcount()) - (stream_.eof() ? 0 : 1);
    line = trimmed(std::string(buffer_.data(), size));
    if (number_ == 1 && line.rfind("\xef\xbb\xbf", 0) == 0) line.erase(0, 3);
    if (!line.empty()) return true;
  }
  if (stream_.eof()) return false;
  ++number_;
  problem_ = stream_.bad() ? "cannot be read" : "too long";
  allowed_ = stream_.bad() ? "a file that can be read" : "at most " + std::to_string(buffer_.size() - 1) + " characters";
  return false;
}

std::vector<std::string> csv_cells(const std::string& line) {
  std::vector<std::string> cells;
  std::size_t begin = 0;
  for (std::size_t comma = line.find(','); comma != std::string::npos; comma = line.find(',', begin)) {
    cells.push_back(trimmed(line.substr(begin, comma - begin)));
    begin = comma + 1;
  }
  cells.push_back(trimmed(line.substr(begin)));
  return cells;
}

}  // namespace verlet_cable

#include "csv_rows.h"

#include <cerrno>
#include <system_error>

#include "named_file.h"
#include "text.h"
#include "verlet_cable/core/quoted_text.h"
#include "verlet_cable/core/scene_desc.h"

namespace verlet_cable {
namespace {

constexpr std::size_t longest_line = 4095;
constexpr std::size_t most_errors = 100;

}  // namespace

std::ifstream open_file(const std::string& path) {
  if (const std::string problem = why_not_readable(path); !problem.empty())
    throw SceneError({"cannot read: " + problem + "; allowed: a file"});
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file.is_open() || file.peek() == std::ifstream::traits_type::eof()) {
    if (!file.is_open() || file.bad() || errno)
      throw SceneError({"cannot read: " + std::generic_category().message(errno ? errno : EIO)});
    file.clear();
  }
  return file;
}

CsvRows::CsvRows(std::istream& stream, const char* header)
    : lines_(stream, longest_line), header_(header), columns_(csv_cells(header_).size()) {}

void CsvRows::add_error(const std::string& what, const std::string& allowed) {
  if (errors_.size() < most_errors) errors_.push_back("line " + std::to_string(line()) + ": " + what + "; allowed: " + allowed);
}

void CsvRows::read_header() {
  begun_ = true;
  std::string line;
  if (lines_.next(line)) {
    if (line != header_) add_error("header " + in_quotes(line), header_);
  } else if (lines_.problem().empty()) {
    errors_.push_back("empty; allowed: the header " + header_ + " and rows");
  }
}

bool CsvRows::next(Cells& cells) {
  if (!begun_) {
    read_header();
    if (!errors_.empty()) return false;
  }
  std::string line;
  while (lines_.problem().empty() && errors_.size() < most_errors && lines_.next(line)) {
    cells = csv_cells(line);
    if (cells.size() == columns_) return true;
    add_error(std::to_string(cells.size()) + " columns", std::to_string(columns_) + ": " + header_);
  }
  if (!lines_.problem().empty()) add_error(lines_.problem(), lines_.allowed());
  return false;
}

void CsvRows::throw_errors() {
  if (errors_.size() == most_errors) errors_.push_back("the rest of the file was not read");
  if (!errors_.empty()) throw SceneError(std::move(errors_));
}

}  // namespace verlet_cable

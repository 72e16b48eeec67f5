#include <cerrno>
#include <fstream>
#include <optional>
#include <system_error>

#include "recording.h"
#include "scene/csv_lines.h"
#include "scene/named_file.h"
#include "scene/text.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/scene_fields.h"

namespace verlet_cable::cable_fit {
namespace {

constexpr std::size_t fewest_markers = 4;  // two at each end give the direction in which the cable is held
constexpr std::size_t fewest_rows = 10;    // of which the first two are the start of the prediction
constexpr std::size_t most_errors = 100;
constexpr std::size_t longest_line = 1'000'000;
/// Of all recordings: fits have taken 1.2 kB of memory for each.
constexpr std::size_t most_numbers = 4'000'000;
constexpr double least_distance = 1e-6;  // [m] of two held markers, for a direction
constexpr double greatest_speed = 1e4;   // [m/s] of a marker
/// [s] of all recordings: a fit simulates them hundreds of times.
constexpr double longest_time = 1e4;

std::vector<std::string> column_names(std::size_t markers) {
  std::vector<std::string> names{"t"};
  for (std::size_t i = 0; i < markers; ++i)
    for (const char* axis : {"x", "y", "z"}) names.push_back(axis + std::to_string(i));
  return names;
}

class RecordingReader {
 public:
  /// `room`: for how many numbers more there is room; becomes less.
  RecordingReader(const std::string& path, std::size_t& room, std::vector<std::string>& errors) : room_(room), errors_(errors) {
    recording_.path = path;
  }

  Recording read() {
    const std::string refused = why_not_readable(recording_.path);
    if (!refused.empty()) {
      errors_.push_back(recording_.path + ": cannot read: " + refused + "; allowed: a file");
      return std::move(recording_);
    }
    errno = 0;
    std::ifstream file(recording_.path, std::ios::binary);
    if (!file.is_open() || (file.peek() == std::ifstream::traits_type::eof() && errno != 0)) {
      errors_.push_back(recording_.path + ": cannot read: " + std::generic_category().message(errno != 0 ? errno : EIO));
      return std::move(recording_);
    }
    file.clear();
    CsvLines lines(file, longest_line);
    std::string line;
    const auto next = [&] {
      const bool good = lines.next(line);
      line_ = lines.number();
      if (!lines.problem().empty()) add_line_error(lines.problem(), lines.allowed());
      return good;
    };
    if (!next()) {
      if (found_ == 0) add_error("", "empty", "the header t,x0,y0,z0,x1,... and rows");
    } else if (read_header(line)) {
      while (found_ < most_errors && next()) add_row(line);
      if (found_ == 0 && recording_.times.size() < fewest_rows)
        add_error("", std::to_string(recording_.times.size()) + " rows", std::to_string(fewest_rows) + " or more");
    }
    if (found_ == most_errors) errors_.push_back(recording_.path + ": not read further");
    if (!recording_.times.empty()) {
      const double first = recording_.times.front();
      for (double& time : recording_.times) time -= first;
    }
    return std::move(recording_);
  }

 private:
  void add_error(const std::string& where, const std::string& what, const std::string& allowed) {
    if (found_ == most_errors) return;
    ++found_;
    errors_.push_back(recording_.path + ": " + where + what + "; allowed: " + allowed);
  }
  void add_line_error(const std::string& what, const std::string& allowed) {
    add_error("line " + std::to_string(line_) + ": ", what, allowed);
  }

  bool read_header(const std::string& line) {
    const std::vector<std::string> cells = csv_cells(line);
    names_ = column_names(cells.size() / 3);
    if (cells == names_ && cells.size() / 3 >= fewest_markers) return true;
    add_line_error("header " + in_quotes(line),
                   "t,x0,y0,z0,x1,y1,z1,... with " + std::to_string(fewest_markers) + " markers or more");
    return false;
  }

  void add_row(const std::string& line) {
    const std::vector<std::string> cells = csv_cells(line);
    if (cells.size() != names_.size())
      return add_line_error(std::to_string(cells.size()) + " columns", std::to_string(names_.size()) + ", as the header has");
    if (cells.size() > room_) {
      add_line_error("too many numbers", "at most " + std::to_string(most_numbers) + " in all recordings");
      found_ = most_errors;
      return;
    }
    room_ -= cells.size();
    const std::size_t found_before = found_;
    std::vector<double> numbers;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const std::optional<double> number = parse_number(cells[i]);
      numbers.push_back(number.value_or(0));
      if (!number || !coordinate.contains(*number))
        add_line_error(names_[i] + " " + in_quotes(cells[i]), coordinate.text(i == 0 ? "s" : "m"));
    }
    if (found_ != found_before) return;
    if (!recording_.times.empty() && numbers[0] <= recording_.times.back())
      return add_line_error("t " + cells[0], "times that ascend, the one before is " + number_text(recording_.times.back()));
    std::vector<Vector3> markers;
    for (std::size_t i = 1; i < numbers.size(); i += 3) markers.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
    for (const std::size_t i : {std::size_t{0}, markers.size() - 2}) {
      if ((markers[i + 1] - markers[i]).norm() < least_distance)
        add_line_error("markers " + std::to_string(i) + " and " + std::to_string(i + 1) + " at the same place",
                       "two places, as they give the direction in which the cable is held");
    }
    if (!recording_.times.empty()) check_speeds(numbers[0] - recording_.times.back(), markers);
    recording_.times.push_back(numbers[0]);
    recording_.markers.push_back(std::move(markers));
  }

  /// `interval`: since the row before [s].
  void check_speeds(double interval, const std::vector<Vector3>& markers) {
    for (std::size_t i = 0; i < markers.size(); ++i) {
      const double speed = (markers[i] - recording_.markers.back()[i]).norm() / interval;
      if (!(speed <= greatest_speed))
        return add_line_error("marker " + std::to_string(i) + " moves at " + rounded_text(speed) + " m/s since the row before, " +
                                  number_text(interval) + " s earlier",
                              "at most " + number_text(greatest_speed) + " m/s");
    }
  }

  std::size_t& room_;
  std::vector<std::string>& errors_;
  std::size_t found_ = 0;
  std::size_t line_ = 0;
  std::vector<std::string> names_;
  Recording recording_;
};

}  // namespace

std::vector<Recording> read_recordings(const std::vector<std::string>& paths, std::vector<std::string>& errors) {
  std::vector<Recording> recordings;
  double time = 0;
  std::size_t room = most_numbers;
  for (const std::string& path : paths) {
    recordings.push_back(RecordingReader(path, room, errors).read());
    if (!recordings.back().times.empty()) time += recordings.back().times.back();
    if (recordings.front().markers.empty() || recordings.back().markers.empty()) continue;
    const int first = recordings.front().marker_count(), count = recordings.back().marker_count();
    if (count != first)
      errors.push_back(path + ": " + std::to_string(count) + " markers; allowed: " + std::to_string(first) + ", as in " +
                       recordings.front().path);
  }
  if (time > longest_time)
    errors.push_back((paths.size() == 1 ? paths.front() : "the recordings") + ": " + rounded_text(time) +
                     " s long in all; allowed: at most " + number_text(longest_time) + " s");
  return recordings;
}

}  // namespace verlet_cable::cable_fit

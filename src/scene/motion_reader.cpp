#include <array>
#include <cerrno>
#include <fstream>
#include <optional>
#include <system_error>

#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/scene_fields.h"
#include "verlet_cable/scene/motion.h"
#include "verlet_cable/scene/text.h"

namespace verlet_cable {
namespace {

constexpr const char* header = "t,frame,x,y,z,qx,qy,qz,qw";
constexpr std::array<const char*, 9> columns{"t", "frame", "x", "y", "z", "qx", "qy", "qz", "qw"};
constexpr std::size_t frame_column = 1;
constexpr std::size_t longest_line = 4096;
constexpr std::size_t most_errors = 100;
constexpr double least_quaternion = 1e-6;

/// The part of a line between blanks.
std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells;
  std::size_t begin = 0;
  for (std::size_t comma = line.find(','); comma != std::string::npos; comma = line.find(',', begin)) {
    cells.push_back(trimmed(line.substr(begin, comma - begin)));
    begin = comma + 1;
  }
  cells.push_back(trimmed(line.substr(begin)));
  return cells;
}

class MotionReader {
 public:
  explicit MotionReader(std::istream& stream) : stream_(stream) {}

  Motion read() {
    std::string line;
    if (next_line(line)) {
      if (line == header) {
        while (errors_.size() < most_errors && next_line(line)) add_row(line);
        if (motion_.empty() && errors_.empty()) errors_.push_back("no rows; allowed: at least one pose");
      } else {
        add_error("header " + quoted(line), header);
      }
    } else if (errors_.empty()) {
      errors_.push_back("empty; allowed: the header " + std::string(header) + " and rows");
    }
    if (errors_.size() == most_errors) errors_.push_back("not read further");
    if (!errors_.empty()) throw SceneError(std::move(errors_));
    return std::move(motion_);
  }

 private:
  /// The next line that is not empty, without blanks at its ends.
  bool next_line(std::string& line) {
    std::array<char, longest_line> buffer;
    while (stream_.getline(buffer.data(), buffer.size())) {
      ++line_;
      line = trimmed(buffer.data());
      if (line_ == 1 && line.rfind("\xef\xbb\xbf", 0) == 0) line.erase(0, 3);
      if (!line.empty()) return true;
    }
    if (!stream_.eof()) {
      ++line_;
      add_error("too long", "at most " + std::to_string(longest_line - 1) + " characters");
    }
    return false;
  }

  void add_error(const std::string& what, const std::string& allowed) {
    errors_.push_back("line " + std::to_string(line_) + ": " + what + "; allowed: " + allowed);
  }

  void add_row(const std::string& line) {
    const std::vector<std::string> cells = split(line);
    if (cells.size() != columns.size())
      return add_error(std::to_string(cells.size()) + " columns", std::to_string(columns.size()) + ": " + header);
    const std::size_t errors_before = errors_.size();
    std::array<double, columns.size()> numbers{};
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (i == frame_column) continue;
      const std::optional<double> number = parse_number(cells[i]);
      if (number && coordinate.contains(*number)) {
        numbers[i] = *number;
      } else {
        add_error(std::string(columns[i]) + " " + quoted(cells[i]), coordinate.text(i == 0 ? "s" : i < 5 ? "m" : ""));
      }
    }
    const std::string& frame = cells[frame_column];
    if (!is_frame_name(frame)) add_error("frame " + quoted(frame), frame_words);
    if (errors_.size() != errors_before) return;

    const Quaternion orientation(numbers[8], numbers[5], numbers[6], numbers[7]);
    if (orientation.norm() < least_quaternion) return add_error("quaternion of length 0", "any other, it is normalized");
    FrameTrack& track = motion_[frame];
    if (!track.empty() && numbers[0] <= track.last_time())
      return add_error("t " + cells[0] + " of " + quoted(frame),
                       "times that ascend, the frame's last one is " + number_text(track.last_time()));
    track.add(numbers[0], {{numbers[2], numbers[3], numbers[4]}, orientation.normalized()});
  }

  std::istream& stream_;
  std::size_t line_ = 0;
  Motion motion_;
  std::vector<std::string> errors_;
};

}  // namespace

Motion read_motion_file(const std::string& path) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file.is_open() || file.peek() == std::ifstream::traits_type::eof()) {
    if (!file.is_open() || file.bad() || errno)
      throw SceneError({"cannot read: " + std::generic_category().message(errno ? errno : EIO)});
    file.clear();
  }
  return MotionReader(file).read();
}

}  // namespace verlet_cable

#include <array>
#include <cerrno>
#include <fstream>
#include <optional>
#include <system_error>

#include "csv_lines.h"
#include "named_file.h"
#include "text.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/scene_fields.h"
#include "verlet_cable/scene/motion.h"

namespace verlet_cable {
namespace {

constexpr const char* header = "t,frame,x,y,z,qx,qy,qz,qw";
constexpr std::array<const char*, 9> columns{"t", "frame", "x", "y", "z", "qx", "qy", "qz", "qw"};
constexpr std::size_t frame_column = 1;
constexpr std::size_t longest_line = 4095;
constexpr std::size_t most_errors = 100;
constexpr std::size_t most_frames = 20000;  // as the node takes from tf
constexpr double least_quaternion = 1e-6;

class MotionReader {
 public:
  explicit MotionReader(std::istream& stream) : lines_(stream, longest_line) {}

  Motion read() {
    std::string line;
    if (lines_.next(line)) {
      if (line == header) {
        while (errors_.size() < most_errors && lines_.next(line)) add_row(line);
        if (!lines_.problem().empty()) add_error(lines_.problem(), lines_.allowed());
        if (motion_.empty() && errors_.empty()) errors_.push_back("no rows; allowed: at least one pose");
      } else {
        add_error("header " + quoted(line), header);
      }
    } else if (!lines_.problem().empty()) {
      add_error(lines_.problem(), lines_.allowed());
    } else {
      errors_.push_back("empty; allowed: the header " + std::string(header) + " and rows");
    }
    if (errors_.size() == most_errors) errors_.push_back("the rest of the file was not read");
    if (!errors_.empty()) throw SceneError(std::move(errors_));
    return std::move(motion_);
  }

 private:
  void add_error(const std::string& what, const std::string& allowed) {
    if (errors_.size() < most_errors)
      errors_.push_back("line " + std::to_string(lines_.number()) + ": " + what + "; allowed: " + allowed);
  }

  void add_row(const std::string& line) {
    const std::vector<std::string> cells = csv_cells(line);
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
    if (motion_.size() >= most_frames && motion_.count(frame) == 0)
      add_error("frame " + quoted(frame), "at most " + std::to_string(most_frames) + " frames");
    if (errors_.size() != errors_before) return;

    const Quaternion orientation(numbers[8], numbers[5], numbers[6], numbers[7]);
    if (orientation.norm() < least_quaternion) return add_error("quaternion of length 0", "any other, it is normalized");
    FrameTrack& track = motion_[frame];
    if (!track.empty() && numbers[0] <= track.last_time())
      return add_error("t " + cells[0] + " of " + quoted(frame),
                       "times that ascend, the frame's last one is " + number_text(track.last_time()));
    track.add(numbers[0], {{numbers[2], numbers[3], numbers[4]}, orientation.normalized()});
  }

  CsvLines lines_;
  Motion motion_;
  std::vector<std::string> errors_;
};

}  // namespace

Motion read_motion_file(const std::string& path) {
  if (const std::string problem = why_not_readable(path); !problem.empty())
    throw SceneError({"cannot read: " + problem + "; allowed: a file"});
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

#include <array>
#include <optional>

#include "csv_rows.h"
#include "text.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/scene_fields.h"
#include "verlet_cable/scene/motion.h"

namespace verlet_cable {
namespace {

constexpr const char* header = "t,frame,x,y,z,qx,qy,qz,qw";
constexpr std::array<const char*, 9> columns{"t", "frame", "x", "y", "z", "qx", "qy", "qz", "qw"};
constexpr std::size_t frame_column = 1;
constexpr std::size_t most_frames = 20000;  // as the node takes from tf
constexpr double least_quaternion = 1e-6;

class MotionReader {
 public:
  explicit MotionReader(std::istream& stream) : rows_(stream, header) {}

  Motion read() {
    rows_.read([this](const CsvRows::Cells& cells) { add_row(cells); });
    if (motion_.empty()) throw SceneError({"no rows; allowed: at least one pose"});
    return std::move(motion_);
  }

 private:
  void add_row(const CsvRows::Cells& cells) {
    const std::size_t errors_before = rows_.errors();
    std::array<double, columns.size()> numbers{};
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (i == frame_column) continue;
      const std::optional<double> number = parse_number(cells[i]);
      if (number && coordinate.contains(*number)) {
        numbers[i] = *number;
      } else {
        rows_.add_error(std::string(columns[i]) + " " + in_quotes(cells[i]), coordinate.text(i == 0 ? "s" : i < 5 ? "m" : ""));
      }
    }
    const std::string& frame = cells[frame_column];
    if (!is_frame_name(frame)) rows_.add_error("frame " + in_quotes(frame), frame_words);
    if (motion_.size() >= most_frames && motion_.count(frame) == 0)
      rows_.add_error("frame " + in_quotes(frame), "at most " + std::to_string(most_frames) + " frames");
    if (rows_.errors() != errors_before) return;

    const Quaternion orientation(numbers[8], numbers[5], numbers[6], numbers[7]);
    if (orientation.norm() < least_quaternion) return rows_.add_error("quaternion of length 0", "any other, it is normalized");
    FrameTrack& track = motion_[frame];
    if (!track.empty() && numbers[0] <= track.last_time())
      return rows_.add_error("t " + cells[0] + " of " + in_quotes(frame),
                             "times that ascend, the frame's last one is " + number_text(track.last_time()));
    track.add(numbers[0], {{numbers[2], numbers[3], numbers[4]}, orientation.normalized()});
  }

  CsvRows rows_;
  Motion motion_;
};

}  // namespace

Motion read_motion_file(const std::string& path) {
  std::ifstream file = open_file(path);
  return MotionReader(file).read();
}

}  // namespace verlet_cable

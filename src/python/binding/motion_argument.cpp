#include "binding/motion_argument.h"

#include <string>
#include <vector>

#include "binding/arguments.h"
#include "binding/text_arguments.h"
#include "scene/frame_source.h"
#include "verlet_cable/core/name_list.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/quoted_text.h"
#include "verlet_cable/core/scene_fields.h"

namespace verlet_cable {
namespace {

FrameTrack read_track(const std::string& name, const py::handle& value) {
  const py::sequence pair =
      py::isinstance<py::sequence>(value) ? py::reinterpret_borrow<py::sequence>(value) : py::sequence(py::list());
  if (pair.size() != 2) throw py::value_error(name + ": " + ascii_text(value) + "; allowed: (times (k,) [s], poses (k, 7))");
  const Numbers times = Numbers::ensure(pair[0]), poses = Numbers::ensure(pair[1]);
  if (!times || !poses)
    throw py::value_error(name + (times ? "[1], poses: " : "[0], times: ") + ascii_text(pair[times ? 1 : 0]) +
                          "; allowed: numbers");
  if (times.ndim() != 1 || times.shape(0) == 0)
    throw py::value_error(name + "[0], times: shape " + shape_text(times) + "; allowed: (k,), k at least 1");
  if (poses.ndim() != 2 || poses.shape(0) != times.shape(0) || poses.shape(1) != 7)
    throw py::value_error(name + "[1], poses: shape " + shape_text(poses) + "; allowed: (" + std::to_string(times.shape(0)) +
                          ", 7)");
  FrameTrack track;
  for (py::ssize_t row = 0; row < times.shape(0); ++row) {
    const double time = times.at(row);
    const auto refuse = [&](const std::string& allowed) {
      throw py::value_error(name + "[0][" + std::to_string(row) + "], times: " + number_text(time) + "; allowed: " + allowed);
    };
    if (!coordinate.contains(time)) refuse(coordinate.text("s"));
    if (!track.empty() && time <= track.last_time())
      refuse("times that ascend, the one before is " + number_text(track.last_time()));
    track.add(time, read_pose(poses.data(row, 0), name + "[1][" + std::to_string(row) + "], poses"));
  }
  return track;
}

Motion read_tracks(const py::dict& tracks, const SceneDesc& scene) {
  Motion motion;
  for (const auto& [key, value] : tracks) {
    const std::string frame = text_of(py::str(key), "motion");
    motion[frame] = read_track("motion[" + in_quotes(frame) + "]", value);
  }
  const std::vector<std::string> unused = unused_frames(scene, motion);
  if (unused.empty()) return motion;
  NameList allowed;
  const std::vector<std::string> names = frame_names(scene);
  for (std::size_t i = 1; i < names.size(); ++i) allowed.add(names[i]);
  throw py::key_error("motion: " + in_quotes(unused.front()) + "; allowed: " + allowed.text("none, the scene has no frames"));
}

/// What `read` makes of a file; errors name it.
template <class Read>
auto read_file(const char* argument, const std::string& path, const Read& read) {
  try {
    return read(path);
  } catch (const SceneError& error) {
    std::vector<std::string> lines = error.errors();
    for (std::string& line : lines) line = argument + (": \"" + escaped(path, path.size())) + "\": " + line;
    throw SceneError(lines);
  }
}

}  // namespace

Motion read_motion(const py::object& given, const SceneDesc& scene) {
  if (given.is_none()) return {};
  const bool tracks = py::isinstance<py::dict>(given);
  const Motion motion = tracks ? read_tracks(given, scene) : read_file("motion", path_of(given, "motion"), read_motion_file);
  std::vector<std::string> errors;
  if (motion.count(scene.frame_id) > 0)
    errors.push_back("motion: frame " + in_quotes(scene.frame_id) + " moves; allowed: any but the fixed frame");
  if (!errors.empty()) throw SceneError(errors);
  return motion;
}

LoadPlayer read_loads(const py::object& given, const SceneDesc& scene) {
  if (given.is_none()) return {};
  return LoadPlayer(read_file("loads", path_of(given, "loads"), [&](const std::string& path) {
    Loads loads = read_loads_file(path);
    const std::vector<std::string> errors = validate_loads(loads, scene);
    if (!errors.empty()) throw SceneError(errors);
    return loads;
  }));
}

}  // namespace verlet_cable

#include "job.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <system_error>

#include "common/messages.h"
#include "common/output_file.h"
#include "scene/frame_source.h"
#include "scene/text.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/scene/scene_reader.h"
#include "vtk_writer.h"

namespace verlet_cable::cable_sim {
namespace {

/// [steps] what rounding may do to the quotient of two times.
constexpr double step_tolerance = 1e-6;
/// As small as it is because two rows must not meet at one step, however long the run is.
constexpr double rate_tolerance = 1e-12;
constexpr double most_steps = 1e12;

void append(const std::string& prefix, const std::vector<std::string>& lines, std::vector<std::string>& errors) {
  for (const std::string& line : lines) errors.push_back(prefix + ": " + line);
}

/// Whether a file would be the directory itself, or one of those that are written into it.
bool is_of_directory(const std::string& path, const std::string& directory) {
  namespace fs = std::filesystem;
  std::error_code error;
  const auto resolved = [&](const std::string& name) {
    const fs::path whole = fs::weakly_canonical(name, error);
    return whole.has_filename() ? whole : whole.parent_path();
  };
  const fs::path file = resolved(path), folder = resolved(directory);
  return !error && (file == folder || (file.parent_path() == folder && is_vtk_name(file.filename().string())));
}

/// `scene_files`: those that the scene names.
void check_outputs(const Options& options, const std::vector<std::string>& scene_files, std::vector<std::string>& errors) {
  struct Output {
    const char* option;
    const std::string& path;
  };
  struct Other {
    const char* what;
    const std::string& path;
  };
  std::vector<Other> others{{"the scene", options.scene}, {"the motion", options.motion}, {"the loads", options.loads}};
  for (const std::string& file : scene_files) others.push_back({"a file of the scene", file});
  others.push_back({"the output", options.output});
  others.push_back({"the output of bodies", options.bodies});
  others.push_back({"the summary", options.summary});
  others.push_back({"the plot", options.plot});
  others.push_back({"the animation", options.gif});
  others.push_back({"the movie", options.movie});
  for (const Output& output : {Output{"--output", options.output}, Output{"--bodies", options.bodies},
                               Output{"--summary", options.summary}, Output{"--plot", options.plot}, Output{"--gif", options.gif},
                               Output{"--movie", options.movie}, Output{"--usd", options.usd}}) {
    if (output.path.empty()) continue;
    const std::string problem = tools::why_not_writable(output.path);
    if (!problem.empty()) errors.push_back(std::string(output.option) + ": " + tools::cannot_write(output.path, problem));
    if (problem.empty() && !options.vtk.empty() && is_of_directory(output.path, options.vtk))
      errors.push_back(std::string(output.option) + ": " + tools::quoted_path(output.path) + " is what --vtk " +
                       tools::quoted_path(options.vtk) + " writes; allowed: another file");
    for (const Other& other : others) {
      if (&other.path == &output.path) break;  // what comes later is compared with this
      if (other.path.empty() || !tools::is_same_file(output.path, other.path)) continue;
      errors.push_back(std::string(output.option) + ": " + tools::quoted_path(output.path) + " is " + other.what +
                       "; allowed: another file");
    }
  }
  if (options.vtk.empty()) return;
  const std::string problem = why_no_directory(options.vtk);
  if (!problem.empty()) errors.push_back("--vtk: " + cannot_write_directory(options.vtk, problem));
}

void check_times(const Options& options, double time_step, std::vector<std::string>& errors) {
  if (options.duration / time_step > most_steps)
    errors.push_back("--duration: " + number_text(options.duration) + "; allowed: at most " +
                     rounded_text(most_steps * time_step) + " s, which is " + number_text(most_steps) + " steps");
  if (options.has_rate && options.rate * time_step > 1 + rate_tolerance)
    errors.push_back("--rate: " + number_text(options.rate) +
                     "; allowed: at most 1 / time_step = " + rounded_text(1 / time_step) + " Hz");
}

/// Frames that hold something and that nothing places.
void check_holders(const Options& options, const SceneDesc& scene, const Motion& motion, std::vector<std::string>& errors) {
  const std::vector<std::string> unused = unused_frames(scene, motion);
  for (const std::string& frame : unplaced_holders(scene, motion)) {
    const std::string nearest = nearest_name(frame, unused);
    errors.push_back(tools::path_text(options.scene) + ": frame " + in_quotes(frame) +
                     ": it has no pose; allowed: initial_pose: [x, y, z, roll, pitch, yaw] (m, rad) beside frame: " +
                     escaped(frame) + " in the scene, or rows of it in --motion MOTION.csv" +
                     (nearest.empty() ? "" : " (did you mean " + in_quotes(nearest) + ", which the scene does not use?)"));
  }
}

void check_motion(const Options& options, const SceneDesc& scene, const Motion& motion, std::vector<std::string>& errors) {
  if (motion.count(scene.frame_id))
    errors.push_back(tools::path_text(options.motion) + ": frame " + in_quotes(scene.frame_id) +
                     " moves; allowed: any but the fixed frame");
  const std::size_t errors_before = errors.size();
  check_holders(options, scene, motion, errors);
  if (errors.size() > errors_before) return;  // distances between places that are not known
  const std::string motion_text = options.motion.empty() ? "" : tools::path_text(options.motion) + " ";
  append(motion_text + "at t = 0", validate_distances(scene, FrameSource(scene, motion).at(0)), errors);
}

}  // namespace

std::int64_t RowSchedule::step_of(std::int64_t row) const {
  return static_cast<std::int64_t>(std::ceil(static_cast<double>(row) * steps_a_row_ - step_tolerance));
}

std::int64_t steps_for(double duration, double time_step) {
  return static_cast<std::int64_t>(std::ceil(duration / time_step - step_tolerance));
}

Job prepare(const Options& options, std::vector<std::string>& errors) {
  Job job;
  const std::size_t errors_before = errors.size();
  bool scene_is_sound = false;
  bool motion_is_sound = true;
  if (!options.scene.empty()) {
    try {
      job.scene = read_scene_file(options.scene);
      scene_is_sound = true;
    } catch (const SceneError& error) {
      append(tools::path_text(options.scene), error.errors(), errors);
    }
  }
  if (!options.motion.empty()) {
    try {
      job.motion = read_motion_file(options.motion);
    } catch (const SceneError& error) {
      append(tools::path_text(options.motion), error.errors(), errors);
      motion_is_sound = false;
    }
  }
  bool loads_are_sound = true;
  if (!options.loads.empty()) {
    try {
      job.loads = read_loads_file(options.loads);
    } catch (const SceneError& error) {
      append(tools::path_text(options.loads), error.errors(), errors);
      loads_are_sound = false;
    }
  }
  check_outputs(options, named_files(job.scene, access_beside(options.scene)), errors);
  if (scene_is_sound) {
    check_times(options, job.scene.time_step, errors);
    if (motion_is_sound) check_motion(options, job.scene, job.motion, errors);
    if (loads_are_sound) append(tools::path_text(options.loads), validate_loads(job.loads, job.scene), errors);
  }
  if (errors.size() > errors_before) return job;
  job.steps = steps_for(options.duration, job.scene.time_step);
  job.settle = options.settle;
  job.rate = options.has_rate ? options.rate : std::min(options.rate, 1 / job.scene.time_step);
  job.rows = 1 + static_cast<std::int64_t>(std::floor(options.duration * job.rate + step_tolerance));
  return job;
}

}  // namespace verlet_cable::cable_sim

#include "command.h"

#include <algorithm>
#include <iostream>
#include <optional>

#include "common/messages.h"
#include "common/program.h"
#include "picture.h"
#include "scene/frame_speed.h"
#include "scene/text.h"
#include "simulation.h"
#include "verlet_cable/core/number_text.h"

namespace verlet_cable::cable_sim {
namespace {

constexpr const char* program = "cable_sim";
constexpr std::size_t room_for_events = 65536;  // [byte]
constexpr std::size_t most_noted = 10;

int refuse(const std::vector<std::string>& errors) {
  return tools::refuse(program, errors, "nothing was simulated");
}

/// The files that a run writes; those that were not asked for stay closed.
struct Outputs {
  tools::OutputFile nodes;
  tools::OutputFile bodies;
  tools::OutputFile summary;
  tools::OutputFile plot;
  tools::OutputFile gif;
  tools::OutputFile movie;
  tools::OutputFile usd;

  void open(const Options& options, std::vector<std::string>& errors) {
    open_one("--output", options.output, nodes, errors);
    open_one("--bodies", options.bodies, bodies, errors);
    open_one("--summary", options.summary, summary, errors);
    open_one("--plot", options.plot, plot, errors);
    open_one("--gif", options.gif, gif, errors);
    open_one("--movie", options.movie, movie, errors);
    open_one("--usd", options.usd, usd, errors);
  }

 private:
  static void open_one(const char* option, const std::string& path, tools::OutputFile& file, std::vector<std::string>& errors) {
    if (path.empty()) return;
    const std::string problem = file.open(path);
    if (!problem.empty()) errors.push_back(std::string(option) + ": " + tools::cannot_write(path, problem));
  }
};

/// `time`: simulated so far [s]. `full`: what happened where the disk became full and some is kept, else empty.
bool finish(tools::OutputFile& file, const std::string& path, double time, const std::string& full = "") {
  if (path.empty()) return true;
  const std::string problem = file.finish();
  if (problem.empty() && full.empty()) return true;
  std::cerr << program << ": stopped at " << number_text(time) << " s: cannot write " << tools::quoted_path(path) << ": "
            << (problem.empty() ? full : problem) << "\n";
  return false;
}

bool finish_vtk(VtkWriter& vtk, double time) {
  vtk.finish();
  if (vtk.problem().empty()) return true;
  std::cerr << program << ": stopped at " << number_text(time) << " s: " << vtk.problem() << "\n";
  return false;
}

/// Says why a run ended early, but for a file that cannot be written, of which `finish` tells.
void report(RunEnd end, const char* signal, double time) {
  const std::string start = std::string(program) + ": stopped at " + number_text(time) + " s: ";
  if (end == RunEnd::fault) std::cerr << start << "the simulation failed, see the event FAULT\n";
  if (end == RunEnd::signal) std::cerr << start << "ended by " << signal << ", before its duration was over\n";
}

/// "frame" or "frames", and their names, the first of many.
std::string frames_text(const std::vector<std::string>& frames) {
  const std::size_t listed = std::min(frames.size(), most_noted);
  std::string text = frames.size() == 1 ? "frame" : "frames";
  for (std::size_t i = 0; i < listed; ++i) text += (i == 0 ? " " : ", ") + in_quotes(frames[i]);
  return listed < frames.size() ? text + " and " + std::to_string(frames.size() - listed) + " more" : text;
}

void note_unused(const Options& options, const std::vector<std::string>& frames) {
  if (frames.empty()) return;
  std::cerr << program << ": note: " << tools::path_text(options.motion) << ": the scene does not use " << frames_text(frames)
            << "\n";
}

void warn_of_scene(const SceneDesc& scene) {
  const std::vector<std::string> warnings = warnings_of(scene);
  const std::size_t listed = std::min(warnings.size(), most_noted);
  for (std::size_t i = 0; i < listed; ++i) std::cerr << program << ": warning: " << warnings[i] << "\n";
  if (listed < warnings.size()) std::cerr << program << ": and " << warnings.size() - listed << " more warnings\n";
}

void warn_of_unplaced(const std::vector<std::string>& frames) {
  if (frames.empty()) return;
  const bool one = frames.size() == 1;
  std::cerr << program << ": warning: there is no pose of " << frames_text(frames) << (one ? ": it stays" : ": they stay")
            << " at the origin; give one by --motion MOTION.csv or as initial_pose in the scene\n";
}

/// A scene's file without its folder.
std::string title_of(const std::string& scene) {
  return scene.substr(scene.find_last_of('/') + 1);
}

/// Draws a run, if it is asked for. `time`: simulated [s].
bool write_picture(const std::string& path, const char* kind, const Painter& painter, const PictureRecord& record, double time,
                   tools::OutputFile& file) {
  if (path.empty()) return true;
  const Painter::Picture picture = painter.draw(kind, record.json());
  if (picture.problem.empty()) {
    file.write(picture.bytes.data(), picture.bytes.size());
    return finish(file, path, time);
  }
  std::cerr << program << ": cannot draw " << tools::quoted_path(path) << ": " << picture.problem << "\n";
  return false;
}

int simulate_job(const Options& options, const Job& job, const Painter* painter) {
  const FrameSource frames(job.scene, job.motion);
  BoundaryInputs start = frames.at(0);
  limit_frame_velocities(job.scene.max_frame_speed, start);
  World world(job.scene, start);
  Outputs outputs;
  std::vector<std::string> errors;
  outputs.open(options, errors);
  std::optional<VtkWriter> vtk;
  if (!options.vtk.empty() && errors.empty()) {
    vtk.emplace(world, options.vtk);
    if (!vtk->problem().empty()) errors.push_back("--vtk: " + vtk->problem());
  }
  if (!errors.empty()) return refuse(errors);
  warn_of_scene(job.scene);
  note_unused(options, unused_frames(job.scene, job.motion));
  warn_of_unplaced(unplaced_frames(job.scene, job.motion));

  const bool has_data = tools::is_standard_output(options.output) || tools::is_standard_output(options.bodies) ||
                        tools::is_standard_output(options.summary);
  tools::ProgressBar progress(options.duration, nullptr, has_data);
  EventLog events(progress);
  LoadPlayer loads(job.loads);
  loads.apply_due(world);
  if (job.settle) world.settle();
  const tools::StopRequest stop;
  events.add_starts(world);
  CsvWriter nodes(outputs.nodes, node_columns), bodies(outputs.bodies, body_columns);
  Summary summary(world, averaged_steps(job));
  std::optional<PictureRecord> pictures;
  if (painter) pictures.emplace(world, title_of(options.scene), job.steps);
  std::optional<UsdRecord> usd;
  if (!options.usd.empty()) usd.emplace(world, title_of(options.scene), job.rate);
  // A summary tells of a disk that rows have filled.
  if (!options.summary.empty()) outputs.summary.reserve(2 * summary.json(world, {}).size() + room_for_events);
  const RunEnd end =
      simulate(job, frames, loads, world,
               {options.output.empty() ? nullptr : &nodes, options.bodies.empty() ? nullptr : &bodies,
                pictures ? &*pictures : nullptr, usd ? &*usd : nullptr, vtk ? &*vtk : nullptr, summary, events, progress, stop});
  progress.clear();
  report(end, stop.signal(), world.time());

  if (!options.output.empty()) nodes.flush();
  if (!options.bodies.empty()) bodies.flush();
  bool good = finish(outputs.nodes, options.output, world.time(), nodes.keep_whole_times());
  good = finish(outputs.bodies, options.bodies, world.time(), bodies.keep_whole_times()) && good;
  if (!options.summary.empty()) {
    const std::string json = summary.json(world, events.events());
    outputs.summary.write(json.data(), json.size());
  }
  good = finish(outputs.summary, options.summary, world.time()) && good;
  if (usd) {
    const std::string text = usd->text();
    outputs.usd.write(text.data(), text.size());
    good = finish(outputs.usd, options.usd, world.time()) && good;
  }
  if (vtk) good = finish_vtk(*vtk, world.time()) && good;
  if (painter) {
    good = write_picture(options.plot, "png", *painter, *pictures, world.time(), outputs.plot) && good;
    good = write_picture(options.gif, "gif", *painter, *pictures, world.time(), outputs.gif) && good;
    const char* kind = has_ending(options.movie, ".mp4") ? "mp4" : "gif";
    good = write_picture(options.movie, kind, *painter, *pictures, world.time(), outputs.movie) && good;
  }
  good = tools::print_result(program, summary.line(world) + "\n", has_data) && good;
  return good && end == RunEnd::done ? tools::exit_done : tools::exit_stopped;
}

}  // namespace

int run(const std::vector<std::string>& arguments) {
  std::vector<std::string> errors;
  const Options options = parse_options(arguments, errors);
  if (!options.help.empty()) {
    std::cout << options.help;
    return tools::exit_done;
  }
  const Job job = prepare(options, errors);
  std::optional<Painter> painter;
  if (!options.plot.empty() || !options.gif.empty() || !options.movie.empty()) {
    painter.emplace(has_ending(options.movie, ".mp4"));
    if (!painter->problem().empty()) {
      const char* option = !options.plot.empty() ? "--plot" : !options.gif.empty() ? "--gif" : "--movie";
      errors.push_back(std::string(option) + ": " + painter->problem());
    }
    if (!painter->movie_problem().empty()) errors.push_back("--movie: " + painter->movie_problem());
  }
  if (!errors.empty()) return refuse(errors);
  try {
    return simulate_job(options, job, painter ? &*painter : nullptr);
  } catch (const SceneError& error) {
    return refuse(error.errors());
  }
}

}  // namespace verlet_cable::cable_sim

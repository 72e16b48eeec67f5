#include "command.h"

#include <iostream>

#include "simulation.h"
#include "verlet_cable/scene/text.h"

namespace verlet_cable::cable_sim {
namespace {

int refuse(const std::vector<std::string>& errors) {
  for (const std::string& error : errors) std::cerr << "cable_sim: " << error << "\n";
  std::cerr << "cable_sim: " << errors.size() << (errors.size() == 1 ? " error" : " errors") << ", nothing was simulated\n";
  return exit_bad_input;
}

/// The files that a run writes; those that were not asked for stay closed.
struct Outputs {
  OutputFile csv;
  OutputFile summary;

  /// Opens and empties both, or neither.
  void open(const Options& options, std::vector<std::string>& errors) {
    open_one("--output", options.output, csv, errors);
    open_one("--summary", options.summary, summary, errors);
    if (!errors.empty()) return;
    if (!options.output.empty()) csv.start();
    if (!options.summary.empty()) summary.start();
  }

 private:
  static void open_one(const char* option, const std::string& path, OutputFile& file, std::vector<std::string>& errors) {
    if (path.empty()) return;
    const std::string problem = file.open(path);
    if (!problem.empty())
      errors.push_back(std::string(option) + ": cannot write " + quoted(path) + ": " + problem +
                       "; allowed: a file that can be written");
  }
};

bool finish(OutputFile& file, const std::string& path) {
  if (path.empty()) return true;
  const std::string problem = file.close();
  if (!problem.empty()) std::cerr << "cable_sim: stopped: cannot write " << quoted(path) << ": " << problem << "\n";
  return problem.empty();
}

int simulate_job(const Options& options, const Job& job) {
  const FrameSource frames(job.scene, job.motion);
  World world(job.scene, frames.at(0));
  Outputs outputs;
  std::vector<std::string> errors;
  outputs.open(options, errors);
  if (!errors.empty()) return refuse(errors);
  for (const std::string& frame : unused_frames(job.scene, job.motion))
    std::cerr << "cable_sim: note: " << options.motion << ": nothing in the scene follows frame " << quoted(frame) << "\n";

  ProgressBar progress(options.duration);
  EventLog events(progress);
  if (job.settle) world.settle();
  events.add_unsettled(world);
  CsvWriter csv(outputs.csv);
  Summary summary(world, first_averaged_step(job));
  bool good = simulate(job, options.rate, frames, world, {options.output.empty() ? nullptr : &csv, summary, events, progress});
  progress.clear();
  if (!good) std::cerr << "cable_sim: stopped: a fault at " << world.time() << " s\n";

  if (!options.output.empty()) csv.flush();
  if (!options.summary.empty()) {
    const std::string json = summary.json(world, events.events());
    outputs.summary.write(json.data(), json.size());
  }
  good = finish(outputs.csv, options.output) && good;
  good = finish(outputs.summary, options.summary) && good;
  std::cout << summary.line(world) << "\n";
  return good ? exit_done : exit_stopped;
}

}  // namespace

int run(const std::vector<std::string>& arguments) {
  std::vector<std::string> errors;
  const Options options = parse_options(arguments, errors);
  if (options.help) {
    std::cout << usage;
    return exit_done;
  }
  const Job job = prepare(options, errors);
  if (!errors.empty()) return refuse(errors);
  try {
    return simulate_job(options, job);
  } catch (const SceneError& error) {
    return refuse(error.errors());
  }
}

}  // namespace verlet_cable::cable_sim

#include "command.h"

#include <chrono>
#include <iostream>
#include <numeric>

#include "cable_sim/output_file.h"
#include "cable_sim/progress_bar.h"
#include "least_squares.h"
#include "options.h"
#include "report.h"
#include "smoothing.h"
#include "verlet_cable/scene/text.h"

namespace verlet_cable::cable_fit {
namespace {

int refuse(const std::vector<std::string>& errors) {
  for (const std::string& error : errors) std::cerr << "cable_fit: " << error << "\n";
  std::cerr << "cable_fit: " << errors.size() << (errors.size() == 1 ? " error" : " errors") << ", nothing was fitted\n";
  return exit_bad_input;
}

void check_output(const char* option, const std::string& path, const std::vector<std::string>& others,
                  std::vector<std::string>& errors) {
  if (path.empty()) return;
  const std::string problem = cable_sim::why_not_writable(path);
  if (!problem.empty())
    errors.push_back(std::string(option) + ": cannot write " + quoted(path) + ": " + problem +
                     "; allowed: a file in a directory that can be written");
  for (const std::string& other : others)
    if (!other.empty() && cable_sim::is_same_file(path, other))
      errors.push_back(std::string(option) + ": " + quoted(path) + " is " + quoted(other) + "; allowed: another file");
}

/// Empty, or why not all of the text could be written.
std::string write_file(const std::string& path, const std::string& text) {
  cable_sim::OutputFile file;
  std::string problem = file.open(path);
  if (problem.empty()) {
    file.start();
    file.write(text.data(), text.size());
    problem = file.close();
  }
  return problem.empty() ? "" : "cannot write " + quoted(path) + ": " + problem;
}

FitResult fit_all(Problem& problem, const std::vector<Recording>& as_numbered, bool with_cross_validation) {
  const int count = static_cast<int>(problem.recordings.size());
  int simulations = most_simulations(problem, count);
  const bool cross_validated = with_cross_validation && count > 1;
  if (cross_validated)
    for (const std::vector<int>& left_out : left_out_together(count))
      simulations += most_simulations(problem, count - static_cast<int>(left_out.size()), for_predictions);
  cable_sim::ProgressBar progress(simulations, "simulations at most");
  int done = 0;
  problem.simulated = [&] { progress.show(++done, std::chrono::steady_clock::now()); };

  std::vector<int> all(count);
  std::iota(all.begin(), all.end(), 0);
  FitResult result;
  result.values = fit(problem, all, coarse_search(problem, all));
  result.confidence = confidence(problem, result.values);
  const auto errors = [&](const std::vector<FittedCable>& cables) {
    return Errors{prediction_errors(cables, as_numbered), prediction_errors(cables, problem.recordings)};
  };
  result.fitted = errors(std::vector<FittedCable>(count, {problem.settings, result.values}));
  if (cross_validated) result.left_out = errors(left_out_fits(problem));
  return result;
}

}  // namespace

int run(const std::vector<std::string>& arguments) {
  std::vector<std::string> errors;
  const Options options = parse_options(arguments, errors);
  if (options.help) {
    std::cout << usage;
    return exit_done;
  }
  std::vector<std::string> others = options.recordings;
  check_output("--output", options.output, others, errors);
  others.push_back(options.output);
  check_output("--report", options.report, others, errors);
  const std::vector<Recording> as_numbered = read_recordings(options.recordings, errors);
  if (!errors.empty()) return refuse(errors);
  std::vector<SwappedEnds> swapped;
  std::vector<Recording> recordings;
  for (const Recording& recording : as_numbered) {
    swapped.push_back(swapped_ends(recording));
    recordings.push_back(in_order(recording, swapped.back()));
    if (swapped.back().any())
      std::cerr << "cable_fit: note: " << recording.path << ": " << swapped_text(swapped.back())
                << " markers double back: fitted with their places swapped\n";
  }
  CableSettings settings;
  settings.name = options.name;
  settings.segments = options.segments;
  settings.linear_density = options.linear_density;
  settings.radius = options.radius;
  std::vector<Smoothed> inputs;
  for (const Recording& recording : recordings) inputs.push_back(smoothed(recording));
  measure_cable(recordings, inputs, settings, errors);
  if (!errors.empty()) return refuse(errors);

  Problem problem{recordings, inputs, settings, cable_parameters(settings), {}};
  const FitResult result = fit_all(problem, as_numbered, !options.report.empty());
  std::cout << summary_text(problem, swapped, result);
  std::string failure = write_file(options.output, scene_yaml(problem, result));
  if (failure.empty() && !options.report.empty()) failure = write_file(options.report, report_json(problem, swapped, result));
  if (failure.empty()) return exit_done;
  std::cerr << "cable_fit: stopped: " << failure << "\n";
  return exit_stopped;
}

}  // namespace verlet_cable::cable_fit

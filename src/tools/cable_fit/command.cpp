#include "command.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <numeric>
#include <set>

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

std::string prediction_path(const std::string& directory, const std::string& recording) {
  return (std::filesystem::path(directory) / std::filesystem::path(recording).filename()).string();
}

/// The directory may not be there yet; nothing is made of what may still be refused.
void check_predictions(const std::string& directory, const std::vector<std::string>& recordings,
                       std::vector<std::string>& errors) {
  if (directory.empty()) return;
  std::filesystem::path nearest = std::filesystem::absolute(directory);
  while (!std::filesystem::exists(nearest)) nearest = nearest.parent_path();
  if (!std::filesystem::is_directory(nearest))
    errors.push_back("--predictions: no directory " + quoted(directory) + " can be made: " + quoted(nearest.string()) +
                     " is a file; allowed: a directory, or where one can be made");
  std::set<std::string> names;
  for (const std::string& recording : recordings) {
    const std::string path = prediction_path(directory, recording);
    if (!names.insert(path).second)
      errors.push_back("--predictions: two recordings would be " + quoted(path) +
                       "; allowed: recordings with names of their own");
    if (cable_sim::is_same_file(path, recording))
      errors.push_back("--predictions: " + quoted(path) + " is a recording; allowed: another directory");
  }
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

/// The same error with half and twice the segments.
std::vector<Resegmented> resegmented(const Problem& problem, const std::vector<double>& values) {
  std::vector<Resegmented> others;
  for (const int segments : {std::max(problem.settings.segments / 2, fewest_segments), 2 * problem.settings.segments}) {
    FittedCable cable{problem.settings, values};
    cable.settings.segments = segments;
    const std::vector<FittedCable> cables(problem.recordings.size(), cable);
    others.push_back({segments, mean_error(prediction_errors(cables, problem.recordings))});
  }
  return others;
}

/// Fits what the problem looks for. `on_markers`: where that is the centre line, the fit of the line through the markers, with
/// which it begins; else null.
FitResult fit_all(const Problem& problem, const std::vector<Recording>& as_numbered, bool cross_validated,
                  const FitResult* on_markers) {
  std::vector<int> all(problem.recordings.size());
  std::iota(all.begin(), all.end(), 0);
  FitResult result;
  result.values =
      fit(problem, all, on_markers ? with_markers_on_line(problem.settings, on_markers->values) : coarse_search(problem, all));
  result.confidence = confidence(problem, result.values);
  const auto errors = [&](const std::vector<FittedCable>& cables) {
    return Errors{prediction_errors(cables, as_numbered), prediction_errors(cables, problem.recordings)};
  };
  result.fitted = errors(std::vector<FittedCable>(all.size(), {problem.settings, result.values}));
  result.resegmented = resegmented(problem, result.values);
  if (!cross_validated) return result;
  result.folds = left_out_fits(problem, on_markers ? on_markers->folds : std::vector<FittedCable>());
  result.left_out = errors(result.folds);
  return result;
}

int most_simulations(const Problem& problem, bool cross_validated) {
  const int count = static_cast<int>(problem.recordings.size());
  int simulations = most_simulations(problem, count, for_parameters);
  if (cross_validated)
    for (const std::vector<int>& left_out : left_out_together(count))
      simulations += most_simulations(problem, count - static_cast<int>(left_out.size()), for_predictions);
  return simulations;
}

/// Empty, or why not all could be written.
std::string write_predictions(const std::string& directory, const Fit& fit) {
  std::error_code problem;
  std::filesystem::create_directories(directory, problem);
  if (problem) return "cannot make the directory " + quoted(directory) + ": " + problem.message();
  const std::vector<Recording>& recordings = fit.problem.recordings;
  const std::vector<Prediction> predicted = predictions(fit.result.folds, recordings);
  std::string failure;
  for (std::size_t i = 0; i < predicted.size() && failure.empty(); ++i)
    failure = write_file(prediction_path(directory, recordings[i].path), prediction_csv(recordings[i], predicted[i]));
  return failure;
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
  others.push_back(options.report);
  check_output("--centre-line", options.centre_line, others, errors);
  check_predictions(options.predictions, options.recordings, errors);
  const std::vector<Recording> as_numbered = read_recordings(options.recordings, errors);
  if (options.recordings.size() == 1 && !options.predictions.empty())
    errors.emplace_back("--predictions: one recording, which no fit leaves out; allowed: two or more");
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
  std::vector<int> all(recordings.size());
  std::iota(all.begin(), all.end(), 0);
  measure_cable(recordings, inputs, all, settings);
  check_starts(recordings, inputs, settings, errors);
  if (!errors.empty()) return refuse(errors);

  const bool cross_validated = recordings.size() > 1 && !(options.report.empty() && options.predictions.empty());
  Fit on_markers{{recordings, inputs, settings, cable_parameters(settings), {}}, {}};
  settings.centre_line = true;
  Fit centre_line{{recordings, inputs, settings, cable_parameters(settings), {}}, {}};
  const bool with_centre_line = !options.centre_line.empty();
  cable_sim::ProgressBar progress(most_simulations(on_markers.problem, cross_validated) +
                                      (with_centre_line ? most_simulations(centre_line.problem, cross_validated) : 0),
                                  "simulations at most");
  int done = 0;
  on_markers.problem.simulated = centre_line.problem.simulated = [&] { progress.show(++done, std::chrono::steady_clock::now()); };
  on_markers.result = fit_all(on_markers.problem, as_numbered, cross_validated, nullptr);
  if (with_centre_line) centre_line.result = fit_all(centre_line.problem, as_numbered, cross_validated, &on_markers.result);
  const Fit* const also = with_centre_line ? &centre_line : nullptr;

  std::cout << summary_text(swapped, on_markers, also);
  std::string failure = write_file(options.output, scene_yaml(on_markers));
  if (failure.empty() && also) failure = write_file(options.centre_line, scene_yaml(*also));
  if (failure.empty() && !options.report.empty()) failure = write_file(options.report, report_json(swapped, on_markers, also));
  if (failure.empty() && !options.predictions.empty())
    failure = write_predictions(options.predictions, also ? *also : on_markers);
  if (failure.empty()) return exit_done;
  std::cerr << "cable_fit: stopped: " << failure << "\n";
  return exit_stopped;
}

}  // namespace verlet_cable::cable_fit

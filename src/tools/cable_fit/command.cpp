#include "command.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <numeric>
#include <set>

#include "cloud_command.h"
#include "common/messages.h"
#include "common/output_file.h"
#include "common/program.h"
#include "common/progress_bar.h"
#include "errors_in_variables.h"
#include "harness_command.h"
#include "least_squares.h"
#include "options.h"
#include "prediction_files.h"
#include "report.h"
#include "scene/text.h"
#include "smoothing.h"
#include "written_files.h"

namespace verlet_cable::cable_fit {
namespace {

constexpr const char* program = "cable_fit";

int refuse(const std::vector<std::string>& errors) {
  return tools::refuse(program, errors, "nothing was fitted");
}

/// Why files cannot be made in a directory that may not be there yet.
std::string why_no_predictions(const std::string& directory) {
  std::error_code error;
  std::filesystem::path missing, nearest = std::filesystem::absolute(directory);
  while (!std::filesystem::exists(nearest, error) && nearest.has_relative_path()) {
    missing = nearest;
    nearest = nearest.parent_path();
  }
  if (!std::filesystem::is_directory(nearest, error)) return tools::quoted_path(nearest.string()) + " is a file";
  return missing.empty() ? "" : tools::why_not_writable(missing.string());
}

/// Nothing is made of what may still be refused.
void check_predictions(const std::string& directory, const std::vector<std::string>& recordings,
                       std::vector<std::string>& errors) {
  if (directory.empty()) return;
  const std::string problem = why_no_predictions(directory);
  if (!problem.empty()) {
    errors.push_back("--predictions: no directory " + tools::quoted_path(directory) + " can be made: " + problem +
                     "; allowed: a directory, or where one can be made");
    return;
  }
  std::set<std::string> names;
  for (const std::string& recording : recordings) {
    const std::string path = prediction_path(directory, recording);
    if (!names.insert(path).second)
      errors.push_back("--predictions: two recordings would be " + in_quotes(path) +
                       "; allowed: recordings with names of their own");
    if (tools::is_same_file(path, recording))
      errors.push_back("--predictions: " + in_quotes(path) + " is a recording; allowed: another directory");
    const std::string refused = std::filesystem::is_directory(directory) ? tools::why_not_writable(path) : "";
    if (!refused.empty()) errors.push_back("--predictions: " + tools::cannot_write(path, refused));
  }
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
/// which it begins; else null. The problem's markers come to where they are along the cable as it bends.
FitResult fit_all(Problem& problem, const std::vector<Recording>& as_numbered, bool cross_validated,
                  const FitResult* on_markers) {
  std::vector<int> all(problem.recordings.size());
  std::iota(all.begin(), all.end(), 0);
  FitResult result;
  result.with_exact_inputs =
      fit(problem, all,
          on_markers ? with_markers_on_line(problem.settings, on_markers->with_exact_inputs) : coarse_search(problem, all));
  Estimate estimate = with_input_errors(problem, all, result.with_exact_inputs, for_parameters.corrections);
  result.values = std::move(estimate.values);
  result.confidence = std::move(estimate.confidence);
  problem.settings.marker_places = std::move(estimate.marker_places);
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
  std::vector<int> all(count);
  std::iota(all.begin(), all.end(), 0);
  int simulations = most_simulations(problem, count, for_parameters) +
                    most_simulations_with_input_errors(problem, all, for_parameters.corrections);
  if (!cross_validated) return simulations;
  for (const std::vector<int>& left_out : left_out_together(count)) {
    const int others = count - static_cast<int>(left_out.size());
    // Alike recordings have about as many errors: those of the first ones.
    const std::vector<int> training(all.begin(), all.begin() + others);
    simulations += most_simulations(problem, others, for_predictions) +
                   most_simulations_with_input_errors(problem, training, for_predictions.corrections);
  }
  return simulations;
}

/// Writes all that was asked for, whatever else fails. `also`: the fit of the centre line, or null.
bool write_results(const Options& options, const std::vector<SwappedEnds>& swapped, const Fit& on_markers, const Fit* also) {
  std::vector<std::string> failures{tools::write_file(options.output, scene_yaml(on_markers))};
  if (also) failures.push_back(tools::write_file(options.centre_line, scene_yaml(*also)));
  if (!options.report.empty()) failures.push_back(tools::write_file(options.report, report_json(swapped, on_markers, also)));
  if (!options.predictions.empty()) {
    const Fit& fit = also ? *also : on_markers;
    const std::vector<Recording>& recordings = fit.problem.recordings;
    write_prediction_files(options.predictions, recordings, predictions(fit.result.folds, recordings), failures);
  }
  return report_failures(failures);
}

/// As an argument in a shell.
std::string shell_text(const std::string& path) {
  constexpr const char* plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./+-=,@%";
  if (path.find_first_not_of(plain) == std::string::npos) return path;
  std::string text = "'";
  for (const char c : path) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

/// Which files were written, and how to look at the scene among them.
std::string written_and_next(const Options& options) {
  const std::string next =
      tools::is_standard_output(options.output)
          ? ""
          : "; see it with: roslaunch verlet_cable replay.launch data:=" + shell_text(options.recordings.front()) +
                " scene:=" + shell_text(options.output);
  return written_text({&options.output, &options.centre_line, &options.report, &options.predictions}, next);
}

}  // namespace

int run(const std::vector<std::string>& arguments) {
  std::vector<std::string> errors;
  const Options options = parse_options(arguments, errors);
  if (!options.help.empty()) {
    std::cout << options.help;
    return tools::exit_done;
  }
  if (!options.clouds.empty()) return run_clouds(options, std::move(errors));
  std::vector<std::string> others = options.recordings;
  check_output("--output", options.output, others, errors);
  if (!options.harness.empty()) others.push_back(options.harness);
  others.push_back(options.output);
  check_output("--report", options.report, others, errors);
  others.push_back(options.report);
  check_output("--centre-line", options.centre_line, others, errors);
  check_predictions(options.predictions, options.recordings, errors);
  const std::vector<Recording> as_numbered = read_recordings(options.recordings, errors);
  if (options.recordings.size() == 1 && !options.predictions.empty())
    errors.emplace_back("--predictions: one recording, which no fit leaves out; allowed: two or more");
  if (!options.harness.empty()) return run_harness(options, as_numbered, std::move(errors));
  if (!errors.empty()) return refuse(errors);
  if (!options.assumed.empty())
    std::cerr << "cable_fit: note: assumed, as not given: " << options.assumed << "; weigh and measure the cable\n";
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
  const bool has_data = tools::is_standard_output(options.output) || tools::is_standard_output(options.report) ||
                        tools::is_standard_output(options.centre_line);
  tools::ProgressBar progress(most_simulations(on_markers.problem, cross_validated) +
                                  (with_centre_line ? most_simulations(centre_line.problem, cross_validated) : 0),
                              "simulations at most", has_data);
  int done = 0;
  on_markers.problem.simulated = centre_line.problem.simulated = [&] { progress.show(++done, std::chrono::steady_clock::now()); };
  on_markers.result = fit_all(on_markers.problem, as_numbered, cross_validated, nullptr);
  if (with_centre_line) centre_line.result = fit_all(centre_line.problem, as_numbered, cross_validated, &on_markers.result);
  const Fit* const also = with_centre_line ? &centre_line : nullptr;

  const bool good = write_results(options, swapped, on_markers, also);
  progress.clear();
  const std::string written = good ? written_and_next(options) : "";
  const bool printed = tools::print_result(program, summary_text(swapped, on_markers, also) + written, has_data);
  return good && printed ? tools::exit_done : tools::exit_stopped;
}

}  // namespace verlet_cable::cable_fit

#include "harness_command.h"

#include <chrono>
#include <iostream>

#include "common/messages.h"
#include "common/output_file.h"
#include "common/program.h"
#include "common/progress_bar.h"
#include "harness_report.h"
#include "prediction_files.h"
#include "written_files.h"

namespace verlet_cable::cable_fit {
namespace {

constexpr const char* program = "cable_fit";

/// Of the trunk what the command line gives, unless the description does.
void take_from_options(const Options& options, Harness& harness) {
  HarnessCable& trunk = harness.cables.front();
  if (!options.assumed.empty() && (trunk.linear_density == 0 || trunk.radius == 0))
    std::cerr << program << ": note: assumed, as neither given nor in " << tools::path_text(options.harness) << ": "
              << options.assumed << "; weigh and measure the cables\n";
  if (trunk.linear_density == 0) trunk.linear_density = options.linear_density;
  if (trunk.radius == 0) trunk.radius = options.radius;
}

}  // namespace

int run_harness(const Options& options, const std::vector<Recording>& recordings, std::vector<std::string> errors) {
  HarnessSettings settings;
  settings.harness = read_harness(options.harness, errors);
  settings.segments = options.segments;
  if (errors.empty()) check_markers(settings.harness, recordings, errors);
  if (!errors.empty()) return tools::refuse(program, errors, "nothing was fitted");
  take_from_options(options, settings.harness);
  std::vector<Smoothed> inputs;
  for (const Recording& recording : recordings) inputs.push_back(harness_input(settings.harness, recording));
  check_harness_starts(recordings, inputs, settings, errors);
  if (!errors.empty()) return tools::refuse(program, errors, "nothing was fitted");

  const bool cross_validated = recordings.size() > 1 && !(options.report.empty() && options.predictions.empty());
  const int parts = cross_validated ? options.parts : 0;
  HarnessProblem problem{recordings, inputs, settings, [] {}};
  const bool has_data = tools::is_standard_output(options.output) || tools::is_standard_output(options.report);
  tools::ProgressBar progress(most_simulations(problem, parts), "simulations at most", has_data);
  int done = 0;
  problem.simulated = [&] { progress.show(++done, std::chrono::steady_clock::now()); };
  const HarnessFit fit = fit_harness(problem, parts);

  std::vector<std::string> failures{tools::write_file(options.output, harness_yaml(fit, recordings.size()))};
  if (!options.report.empty()) failures.push_back(tools::write_file(options.report, harness_json(problem, fit)));
  if (!options.predictions.empty()) write_prediction_files(options.predictions, recordings, fit.predictions, failures);
  const bool good = report_failures(failures);
  progress.clear();
  const bool printed = tools::print_result(
      program, harness_text(problem, fit) + (good ? written_text({&options.output, &options.report, &options.predictions}) : ""),
      has_data);
  return good && printed ? tools::exit_done : tools::exit_stopped;
}

}  // namespace verlet_cable::cable_fit

#include "cloud_command.h"

#include <chrono>

#include "cable_sim/job.h"
#include "cloud_report.h"
#include "common/messages.h"
#include "common/output_file.h"
#include "common/program.h"
#include "common/progress_bar.h"
#include "verlet_cable/core/name_list.h"
#include "written_files.h"

namespace verlet_cable::cable_fit {
namespace {

constexpr const char* fit_program = "cable_fit";

/// The scene and its motion, as cable_sim reads and checks them.
cable_sim::Job read_filmed(const Options& options, double duration, std::vector<std::string>& errors) {
  cable_sim::Options filmed;
  filmed.scene = options.scene;
  filmed.motion = options.motion;
  filmed.duration = duration;
  return cable_sim::prepare(filmed, errors);
}

/// The index of the cable that is looked for; -1: there is none, with a line in `errors`.
int looked_for(const Options& options, const SceneDesc& scene, std::vector<std::string>& errors) {
  NameList names;
  for (std::size_t i = 0; i < scene.cables.size(); ++i) {
    if (scene.cables[i].name == options.cable || (options.cable.empty() && scene.cables.size() == 1)) return static_cast<int>(i);
    names.add(scene.cables[i].name);
  }
  errors.push_back("--cable: " + (options.cable.empty() ? "missing" : in_quotes(options.cable)) +
                   "; allowed: " + names.text("none, the scene has no cables"));
  return -1;
}

}  // namespace

int run_clouds(const Options& options, std::vector<std::string> errors) {
  std::vector<std::string> others{options.clouds, options.scene, options.motion};
  check_output("--output", options.output, others, errors);
  others.push_back(options.output);
  check_output("--report", options.report, others, errors);
  CloudProblem problem{{}, -1, {}, options.clouds.empty() ? Clouds() : read_clouds(options.clouds, errors), {}};
  cable_sim::Job filmed = read_filmed(options, problem.clouds.times.empty() ? 0 : problem.clouds.times.back(), errors);
  if (errors.empty()) problem.cable = looked_for(options, filmed.scene, errors);
  if (!errors.empty()) return tools::refuse(fit_program, errors, "nothing was fitted");
  problem.scene = std::move(filmed.scene);
  problem.motion = std::move(filmed.motion);

  const bool has_data = tools::is_standard_output(options.output) || tools::is_standard_output(options.report);
  tools::ProgressBar progress(most_simulations(problem), "simulations at most", has_data);
  int done = 0;
  problem.simulated = [&] { progress.show(++done, std::chrono::steady_clock::now()); };
  const CloudFit fit = fit_clouds(problem);

  std::vector<std::string> failures{tools::write_file(options.output, clouds_yaml(problem, fit))};
  if (!options.report.empty()) failures.push_back(tools::write_file(options.report, clouds_json(problem, fit)));
  const bool good = report_failures(failures);
  progress.clear();
  const bool printed = tools::print_result(
      fit_program, clouds_text(problem, fit) + (good ? written_text({&options.output, &options.report}) : ""), has_data);
  return good && printed ? tools::exit_done : tools::exit_stopped;
}

}  // namespace verlet_cable::cable_fit

#include "options.h"

#include <set>

#include "common/command_line.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/quoted_text.h"
#include "verlet_cable/core/scene_fields.h"

namespace verlet_cable::cable_fit {
namespace {

constexpr Range segments_range{fewest_segments, 10000, "an integer"};
constexpr const char* file = "the name of a file";

constexpr Range parts_range{2, 1000, "an integer"};
constexpr int harness_segments = 24;

constexpr const char* usage =
    "usage: cable_fit RECORDING.csv... --name NAME --output SCENE.yaml [options]\n"
    "       cable_fit RECORDING.csv... --harness HARNESS.yaml --output SCENE.yaml [options]\n"
    "       cable_fit --clouds CLOUDS.csv --scene FILMED.yaml [--motion MOTION.csv] --output SCENE.yaml [options]\n"
    "Fits a cable to recordings of it: CSV files t,x0,y0,z0,x1,... [s, m] of markers along the cable, of which the first two\n"
    "and the last two are on the grippers that hold it. Or to clouds t,x,y,z [s, m] of points on its surface, in no order.";
constexpr const char* footer = "exit status: 0 done, 2 a bad recording or option, 3 the fit had to stop";

/// Options that only clouds have are wrong without them, and the others' with them.
void check_clouds(const Options& options, std::vector<std::string>& errors) {
  struct Other {
    const char* option;
    const std::string& given;
  };
  const bool with_clouds = !options.clouds.empty();
  const Other of_clouds[] = {{"--scene", options.scene}, {"--motion", options.motion}, {"--cable", options.cable}};
  const Other of_markers[] = {{"--name", options.name},
                              {"--harness", options.harness},
                              {"--centre-line", options.centre_line},
                              {"--predictions", options.predictions}};
  for (const Other& other : of_clouds)
    if (!with_clouds && !other.given.empty())
      errors.push_back(std::string(other.option) + ": " + in_quotes(other.given) + "; allowed: with --clouds only");
  for (const Other& other : of_markers)
    if (with_clouds && !other.given.empty())
      errors.push_back(std::string(other.option) + ": " + in_quotes(other.given) + "; allowed: none with --clouds");
  if (!with_clouds) return;
  if (options.scene.empty()) errors.emplace_back("--scene: missing; allowed with --clouds: the scene that was filmed");
  for (const std::string& path : options.recordings)
    errors.push_back(in_quotes(path) + ": a recording of markers; allowed: none with --clouds");
}

void check_required(const Options& options, bool left_out, std::vector<std::string>& errors) {
  if (options.output.empty()) errors.emplace_back("--output: missing; allowed: the name of a file");
  check_clouds(options, errors);
  if (!options.clouds.empty()) return;
  if (options.recordings.empty() && !left_out)
    errors.emplace_back(
        "no recordings; type: cable_fit RECORDING.csv... --name NAME --output SCENE.yaml; cable_fit --help lists the options");
  std::set<std::string> seen;
  for (const std::string& path : options.recordings)
    if (!seen.insert(path).second) errors.push_back(in_quotes(path) + ": given twice; allowed: each recording once");
  if (!options.harness.empty()) {
    if (!options.name.empty())
      errors.push_back("--name: " + in_quotes(options.name) + "; allowed: none, cables of a harness have theirs");
    if (!options.centre_line.empty())
      errors.push_back("--centre-line: " + in_quotes(options.centre_line) + "; allowed: none with --harness");
  } else if (options.name.empty()) {
    errors.push_back(std::string("--name: missing; allowed: ") + name_words);
  } else if (!is_name(options.name)) {
    errors.push_back("--name: " + in_quotes(options.name) + "; allowed: " + name_words);
  }
}

/// Takes what was given; what is 0 was not: the option with its default.
std::string use_or_assume(double given, const char* option, const char* unit, double& value) {
  if (given == 0) return std::string(option) + " " + number_text(value) + " " + unit;
  value = given;
  return "";
}

}  // namespace

Options parse_options(const std::vector<std::string>& arguments, std::vector<std::string>& errors) {
  Options options;
  tools::CommandLine line(usage, footer);
  line.add_text("--name", "NAME", "of the cable and its material", options.name, name_words);
  line.add_text("--output", "YAML", "the scene: materials and cables, without initial and attachments", options.output, file);
  line.add_text("--harness", "YAML",
                "the recordings are of a cable with branches: its `cables`, each with `name`, `markers: [first, last]` and,\n"
                "but for the first one, `from`, the marker at which it leaves another; and `held`, the markers on what\n"
                "holds it",
                options.harness, file);
  line.add_text("--clouds", "CSV",
                "points t,x,y,z of the cable's surface as a depth camera saw them, instead of recordings of markers; see\n"
                "clouds_to_csv",
                options.clouds, file);
  line.add_text("--scene", "YAML",
                "with --clouds: the scene that was filmed, with what holds the cable, its linear density and radius, and about\n"
                "its length; without `initial` the cable hangs at rest at first",
                options.scene, file);
  line.add_text("--motion", "CSV", "with --clouds: how the scene's frames moved, as for cable_sim", options.motion, file);
  line.add_text("--cable", "NAME", "with --clouds: the cable that is looked for; not needed if there is only one", options.cable,
                name_words);
  int segments = 0, parts = 0;
  line.add_integer("--segments", "N", "of the cable, default 40; of a harness' first cable, default 24", segments,
                   segments_range);
  double linear_density = 0, radius = 0;
  line.add_number("--linear-density", "KG_M", "default 0.1; stiffness and damping are found in proportion to it", linear_density,
                  positive, "kg/m");
  line.add_number("--radius", "M", "default 0.005; it is not fitted", radius, positive, "m");
  line.add_text("--report", "JSON", "confidence intervals, and errors for fitted and for left-out recordings", options.report,
                file);
  line.add_text("--centre-line", "YAML",
                "fit the centre line, too, and the offsets of the markers from it: its scene, with attachments;\n"
                "its errors are in the report",
                options.centre_line, file);
  line.add_text("--predictions", "DIR", "predictions of the recordings by fits without them, for the centre line if it is fitted",
                options.predictions, "the name of a directory");
  line.add_integer("--parts", "N",
                   "with --harness: in so many parts, of every N-th recording each, recordings are left out, each part of\n"
                   "a fit to all others; default 2",
                   parts, parts_range);
  options.recordings = line.parse(arguments, errors);
  if (segments > 0 || !options.harness.empty()) options.segments = segments > 0 ? segments : harness_segments;
  if (parts > 0) options.parts = parts;
  if (parts > 0 && options.harness.empty())
    errors.push_back("--parts: " + std::to_string(parts) + "; allowed: with --harness only");
  options.help = line.help();
  options.assumed = use_or_assume(linear_density, "--linear-density", "kg/m", options.linear_density);
  const std::string radius_text = use_or_assume(radius, "--radius", "m", options.radius);
  if (!options.clouds.empty() && (linear_density > 0 || radius > 0))
    errors.emplace_back("--linear-density, --radius: given; allowed: none with --clouds, the scene has both");
  if (!radius_text.empty()) options.assumed += (options.assumed.empty() ? "" : ", ") + radius_text;
  if (options.help.empty()) check_required(options, line.left_out(), errors);
  return options;
}

}  // namespace verlet_cable::cable_fit

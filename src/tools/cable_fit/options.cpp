#include "options.h"

#include <algorithm>
#include <iterator>
#include <set>

#include "scene/text.h"
#include "verlet_cable/core/scene_fields.h"

namespace verlet_cable::cable_fit {
namespace {

constexpr Range segments_range{fewest_segments, 10000, "an integer"};

/// An option and where its value is kept: one of the three.
struct ValueOption {
  const char* name;
  std::string Options::*text;
  double Options::*number;
  int Options::*integer;
  Range range;
  const char* allowed;
};

constexpr ValueOption value_options[] = {
    {"--name", &Options::name, nullptr, nullptr, {}, name_words},
    {"--output", &Options::output, nullptr, nullptr, {}, "the name of a file"},
    {"--report", &Options::report, nullptr, nullptr, {}, "the name of a file"},
    {"--centre-line", &Options::centre_line, nullptr, nullptr, {}, "the name of a file"},
    {"--predictions", &Options::predictions, nullptr, nullptr, {}, "the name of a directory"},
    {"--segments", nullptr, nullptr, &Options::segments, segments_range, ""},
    {"--linear-density", nullptr, &Options::linear_density, nullptr, positive, "kg/m"},
    {"--radius", nullptr, &Options::radius, nullptr, positive, "m"},
};

std::string allowed_values(const ValueOption& option) {
  return option.text ? option.allowed : option.range.text(option.allowed);
}

void set_value(const ValueOption& option, const std::string& value, Options& options, std::vector<std::string>& errors) {
  const auto refuse = [&] {
    errors.push_back(std::string(option.name) + ": " + quoted(value) + "; allowed: " + allowed_values(option));
  };
  if (option.text) {
    if (value.empty()) refuse();
    options.*option.text = value;
    return;
  }
  const auto number = parse_number(value);
  if (!number || !option.range.contains(*number)) return refuse();
  if (option.number) {
    options.*option.number = *number;
  } else if (*number == static_cast<int>(*number)) {
    options.*option.integer = static_cast<int>(*number);
  } else {
    refuse();
  }
}

void add_unknown(const std::string& argument, const std::string& name, std::vector<std::string>& errors) {
  std::vector<std::string> names{"--help"};
  std::string allowed = "--help";
  for (const ValueOption& option : value_options) {
    names.emplace_back(option.name);
    allowed += std::string(", ") + option.name;
  }
  const std::string nearest = nearest_name(name, names);
  errors.push_back(escaped(argument) + ": no such option" + (nearest.empty() ? "" : " (did you mean " + nearest + "?)") +
                   "; allowed: " + allowed);
}

void check_required(const Options& options, std::vector<std::string>& errors) {
  if (options.recordings.empty())
    errors.emplace_back(
        "no recordings; type: cable_fit RECORDING.csv... --name NAME --output SCENE.yaml; cable_fit --help lists the options");
  std::set<std::string> seen;
  for (const std::string& path : options.recordings)
    if (!seen.insert(path).second) errors.push_back(quoted(path) + ": given twice; allowed: each recording once");
  if (options.name.empty()) {
    errors.push_back(std::string("--name: missing; allowed: ") + name_words);
  } else if (!is_name(options.name)) {
    errors.push_back("--name: " + quoted(options.name) + "; allowed: " + name_words);
  }
  if (options.output.empty()) errors.emplace_back("--output: missing; allowed: the name of a file");
}

}  // namespace

const char* const usage =
    "usage: cable_fit RECORDING.csv... --name NAME --output SCENE.yaml [options]\n"
    "Finds the cable that predicts recordings best: t,x0,y0,z0,x1,... [s, m], markers along the cable, the first two and the\n"
    "last two on what holds it.\n"
    "  --name NAME            of the cable and its material\n"
    "  --output YAML          the scene: materials and cables, without initial and attachments\n"
    "  --segments N           of the cable, default 40\n"
    "  --linear-density KG_M  default 0.1; recordings tell stiffnesses and dampings over weight only\n"
    "  --radius M             default 0.005; recordings do not tell it\n"
    "  --report JSON          intervals, errors, and errors on recordings that were left out\n"
    "  --centre-line YAML     the scene, with attachments, of the cable's centre line, looked for together with how far off it\n"
    "                         the markers sit; its errors are in the report, too\n"
    "  --predictions DIR      recordings as predicted by fits that did not know them, of the centre line if it is looked for\n"
    "  --help                 this text\n"
    "exit status: 0 done, 2 a bad recording or option, 3 the fit had to stop\n";

Options parse_options(const std::vector<std::string>& arguments, std::vector<std::string>& errors) {
  Options options;
  std::set<std::string> given;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& argument = arguments[i];
    if (argument.rfind("__", 0) == 0 && argument.find(":=") != std::string::npos) continue;
    if (argument.size() < 2 || argument[0] != '-') {
      options.recordings.push_back(argument);
      continue;
    }
    if (argument == "--help" || argument == "-h") {
      options.help = true;
      continue;
    }
    const std::size_t equals = argument.find('=');
    const std::string name = argument.substr(0, equals);
    const auto option =
        std::find_if(std::begin(value_options), std::end(value_options), [&](const ValueOption& o) { return name == o.name; });
    if (option == std::end(value_options)) {
      add_unknown(argument, name, errors);
      continue;
    }
    if (!given.insert(name).second) errors.push_back(name + ": given twice; allowed: once");
    if (equals != std::string::npos) {
      set_value(*option, argument.substr(equals + 1), options, errors);
    } else if (i + 1 < arguments.size() && arguments[i + 1].rfind("--", 0) != 0) {
      set_value(*option, arguments[++i], options, errors);
    } else {
      errors.push_back(name + ": no value; allowed: " + allowed_values(*option));
    }
  }
  if (!options.help) check_required(options, errors);
  return options;
}

}  // namespace verlet_cable::cable_fit

#include "options.h"

#include <algorithm>
#include <set>

#include "scene/text.h"
#include "verlet_cable/core/scene_fields.h"

namespace verlet_cable::cable_sim {
namespace {

constexpr Range duration_range{0, 1e9, "0 or any number above"};
constexpr Range rate_range{1e-9, 1e9, "any number above 0, at most 1 / time_step"};

/// An option with a value: a number with its range, or a text.
struct ValueOption {
  const char* name;
  double Options::*number;
  std::string Options::*text;
  const char* unit;
  Range range;
};

constexpr ValueOption value_options[] = {
    {"--duration", &Options::duration, nullptr, "s", duration_range},
    {"--rate", &Options::rate, nullptr, "Hz", rate_range},
    {"--motion", nullptr, &Options::motion, "", {}},
    {"--output", nullptr, &Options::output, "", {}},
    {"--summary", nullptr, &Options::summary, "", {}},
};

const std::vector<std::string> all_names{"--duration", "--motion", "--output", "--rate", "--summary", "--settle", "--help"};

bool is_ros_argument(const std::string& argument) {
  return argument.rfind("__", 0) == 0 && argument.find(":=") != std::string::npos;
}

void set_value(const ValueOption& option, const std::string& value, Options& options, std::vector<std::string>& errors) {
  const std::string start = std::string(option.name) + ": " + quoted(value) + "; allowed: ";
  if (option.text) {
    if (value.empty()) errors.push_back(start + "the name of a file");
    options.*option.text = value;
    return;
  }
  const auto number = parse_number(value);
  if (number && option.range.contains(*number)) {
    options.*option.number = *number;
  } else {
    errors.push_back(start + option.range.text(option.unit));
  }
}

}  // namespace

const char* const usage =
    "usage: cable_sim SCENE.yaml [options]\n"
    "Runs a scene offline.\n"
    "  --duration S        time to simulate [s], default 10\n"
    "  --motion CSV        poses of frames over time: t,frame,x,y,z,qx,qy,qz,qw\n"
    "  --output CSV        the nodes over time: t,cable,node,x,y,z,vx,vy,vz,tension\n"
    "  --rate HZ           rows of the output a second, default 100, at most 1 / time_step\n"
    "  --summary JSON      times, energies, forces and events\n"
    "  --settle            put the cables into static equilibrium before t = 0\n"
    "  --help              this text\n"
    "Files are written aside, as NAME.PID-N.part, and renamed when they are whole; devices are written directly. A signal ends "
    "the\n"
    "run between two steps, with what was simulated by then; a second one ends it at once.\n"
    "exit status: 0 done, 2 a bad scene, motion or option, 3 it had to stop: a fault, a full disk, a signal\n";

Options parse_options(const std::vector<std::string>& arguments, std::vector<std::string>& errors) {
  Options options;
  std::set<std::string> given;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& argument = arguments[i];
    if (is_ros_argument(argument)) continue;
    if (argument.size() < 2 || argument[0] != '-') {
      if (!options.scene.empty())
        errors.push_back(quoted(argument) + ": a second scene; allowed: one, it is " + quoted(options.scene));
      if (argument.empty()) errors.push_back("\"\": an empty argument; allowed: the name of a scene file");
      if (options.scene.empty()) options.scene = argument;
      continue;
    }
    const std::size_t equals = argument.find('=');
    const std::string name = argument.substr(0, equals);
    if (!given.insert(name).second) errors.push_back(escaped(name) + ": given twice; allowed: once");
    const auto option =
        std::find_if(std::begin(value_options), std::end(value_options), [&](const ValueOption& o) { return name == o.name; });
    if (option != std::end(value_options)) {
      if (equals != std::string::npos) {
        set_value(*option, argument.substr(equals + 1), options, errors);
      } else if (i + 1 < arguments.size() && arguments[i + 1].rfind("--", 0) != 0) {
        set_value(*option, arguments[++i], options, errors);
      } else {
        errors.push_back(name +
                         ": no value; allowed: " + (option->text ? "the name of a file" : option->range.text(option->unit)));
      }
    } else if (argument == "--help" || argument == "-h") {
      options.help = true;
    } else if (argument == "--settle") {
      options.settle = true;
    } else {
      const std::string nearest = nearest_name(name, all_names);
      std::string allowed;
      for (const std::string& known : all_names) allowed += (allowed.empty() ? "" : ", ") + known;
      errors.push_back(escaped(argument) + ": no such option" + (nearest.empty() ? "" : " (did you mean " + nearest + "?)") +
                       "; allowed: " + allowed);
    }
  }
  if (options.scene.empty() && !options.help)
    errors.push_back("no scene; type: cable_sim SCENE.yaml [options]; cable_sim --help lists the options");
  return options;
}

}  // namespace verlet_cable::cable_sim

#pragma once

#include <string>
#include <vector>

namespace verlet_cable::cable_fit {

/// The command line.
struct Options {
  std::vector<std::string> recordings;  ///< paths
  std::string name;                     ///< of the cable and its material
  std::string output;                   ///< path of the scene
  std::string report;                   ///< path, empty: none
  int segments = 40;
  double linear_density = 0.1;  ///< [kg/m]
  double radius = 0.005;        ///< [m]
  bool help = false;
};

/// What --help prints.
extern const char* const usage;

/// Reads the arguments after the program's name; `--option value` and `--option=value`. Adds a line to `errors` for each that is
/// wrong. Arguments that roslaunch appends (`__name:=...`) are skipped.
Options parse_options(const std::vector<std::string>& arguments, std::vector<std::string>& errors);

}  // namespace verlet_cable::cable_fit

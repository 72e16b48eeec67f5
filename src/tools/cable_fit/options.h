#pragma once

#include <string>
#include <vector>

namespace verlet_cable::cable_fit {

constexpr int fewest_segments = 4;

/// The command line.
struct Options {
  std::vector<std::string> recordings;  ///< paths
  std::string name;                     ///< of the cable and its material
  std::string output;                   ///< path of the scene
  std::string report;                   ///< path, empty: none
  std::string centre_line;              ///< path of the scene of the centre line, empty: it is not looked for
  std::string predictions;              ///< directory, empty: none
  std::string harness;                  ///< path of its description, empty: the recordings are of a single cable
  std::string clouds;                   ///< path of points of a surface, empty: the recordings are of markers
  std::string scene;                    ///< path, with clouds: what was filmed
  std::string motion;                   ///< path, with clouds, empty: nothing moves
  std::string cable;                    ///< with clouds: the one that is looked for, empty: the only one
  int parts = 2;                        ///< in which recordings of a harness are left out
  int segments = 40;
  double linear_density = 0.1;  ///< [kg/m]
  double radius = 0.005;        ///< [m]
  std::string assumed;          ///< the options above that were not given, with their defaults
  std::string help;             ///< what --help prints, empty: not asked for
};

/// Reads the arguments after the program's name. Adds a line to `errors` for each that is wrong.
Options parse_options(const std::vector<std::string>& arguments, std::vector<std::string>& errors);

}  // namespace verlet_cable::cable_fit

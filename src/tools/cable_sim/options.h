#pragma once

#include <string>
#include <vector>

namespace verlet_cable::cable_sim {

/// The command line.
struct Options {
  std::string scene;      ///< path
  double duration = 10;   ///< [s]
  double rate = 100;      ///< [Hz] of rows
  bool has_rate = false;  ///< whether that was given
  std::string motion;     ///< path, empty: none
  std::string loads;      ///< path, empty: none
  std::string output;     ///< path, empty: none
  std::string bodies;     ///< path, empty: none
  std::string summary;    ///< path, empty: none
  std::string plot;       ///< path of a PNG file, empty: none
  std::string gif;        ///< path, empty: none
  std::string movie;      ///< path of a GIF or MP4 file, empty: none
  std::string usd;        ///< path, empty: none
  std::string vtk;        ///< path of a directory, empty: none
  bool settle = false;    ///< into equilibrium before t = 0
  std::string help;       ///< what --help prints, empty: not asked for
};

/// Whether a name has something before that ending.
bool has_ending(const std::string& path, const std::string& ending);

/// Reads the arguments after the program's name. Adds a line to `errors` for each that is wrong.
Options parse_options(const std::vector<std::string>& arguments, std::vector<std::string>& errors);

}  // namespace verlet_cable::cable_sim

#pragma once

#include <array>
#include <string>
#include <vector>

#include "prediction.h"
#include "smoothing.h"
#include "verlet_cable/core/scene_desc.h"

namespace verlet_cable::cable_fit {

/// What is given, not looked for.
struct CableSettings {
  std::string name;
  int segments = 40;
  double linear_density = 0.1;        ///< [kg/m]; motion tells stiffnesses and dampings over weight only
  double radius = 0.005;              ///< [m]; motion does not tell it
  double length = 0;                  ///< [m] as measured between the outer markers
  double shortest = 0, longest = 0;   ///< [m] what the length of a line through the markers may be
  std::vector<double> marker_places;  ///< fractions of the length, as measured
  std::array<double, 2> held{0, 0};   ///< [m] between the two markers on each hand, as measured
  HeldDirections usual_directions;    ///< of the hands, as measured
  /// What is looked for is the cable's centre line, and how far off it the markers sit; else the line through the markers.
  bool centre_line = false;
};

/// A number that a fit looks for, in the scale in which it looks: the decimal logarithm where that can only be above zero.
struct Parameter {
  std::string key;  ///< of the scene
  std::string unit;
  bool logarithmic = false;
  double lowest = 0, highest = 0;
  double step = 0;  ///< for derivatives
  /// Prior: how far it is likely to be from what is expected, or from another parameter; 0: anything goes. So what the recordings
  /// cannot tell stays where it is plain.
  double likely = 0;
  int relative_to = -1;
  double expected = 0;
  /// One of many that are alike: how far they are from what is expected is learned from the recordings, `likely` at most.
  bool has_common_width = false;
  /// Standard deviation of what the simulation, in segments and time steps, leaves of it even where recordings have no noise.
  double unresolved = 0;
};

/// Measures on some of the recordings what the hands hold and how, where the markers are, and the length and its limits: those
/// with which each of them, as it is and smoothed, is a start that a scene may have.
void measure_cable(const std::vector<Recording>& recordings, const std::vector<Smoothed>& inputs, const std::vector<int>& which,
                   CableSettings& settings);

/// Adds a line to `errors` for each recording whose start does not go with the measured length.
void check_starts(const std::vector<Recording>& recordings, const std::vector<Smoothed>& inputs, const CableSettings& settings,
                  std::vector<std::string>& errors);

/// Stiffnesses and dampings, the length, what is stiff at the ends, and natural curvature at places along the cable about two
/// axes; then, where the centre line is looked for, how far off it the hands hold the cable and the markers sit, and how far
/// along the cable markers are from where they were measured.
std::vector<Parameter> cable_parameters(const CableSettings& settings);

/// The first of them: bending stiffness, bending damping, drag and torsional stiffness of a material. `key`: `materials.NAME`.
std::vector<Parameter> material_parameters(const std::string& key, double linear_density);
/// Takes some of these values, from the first one on.
void set_material(const std::vector<double>& values, std::size_t count, MaterialDesc& material);
/// Where their fits begin. `bending`, `damping`: as below.
std::vector<double> first_material(double linear_density, double bending, double damping);

/// Where to begin: a straight cable of the measured length. `bending`: EI over the linear density [N m^3 / kg], `damping`: of
/// bending, likewise.
std::vector<double> first_guess(const CableSettings& settings, double bending, double damping);

/// The value that the scene's key has, out of the scale in which it is looked for.
double scene_value(const Parameter& parameter, double value);

/// Values of a line through the markers, where a fit of the centre line begins.
std::vector<double> with_markers_on_line(const CableSettings& settings, std::vector<double> values);

/// Where the markers sit.
Markers markers_of(const CableSettings& settings, const std::vector<double>& values);

/// The scene of a cable: materials, and the cable without `initial` and `attachments`.
SceneDesc cable_scene(const CableSettings& settings, const std::vector<double>& values);

}  // namespace verlet_cable::cable_fit

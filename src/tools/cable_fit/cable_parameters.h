#pragma once

#include <array>
#include <string>
#include <vector>

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
  double shortest = 0, longest = 0;   ///< [m] what the cable's length may be
  std::vector<double> marker_places;  ///< fractions of the length, as measured
  std::array<double, 2> held{0, 0};   ///< [m] between the two markers on each hand, as measured
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
};

/// `marker_places` of some of the recordings.
std::vector<double> marker_places(const std::vector<Smoothed>& inputs, const std::vector<int>& which);

/// Measures what the hands hold, where the markers are, and the length and its limits: those with which every recording, as it is
/// and smoothed, is a start that a scene may have. Adds a line to `errors` for recordings that have none in common with the
/// others.
void measure_cable(const std::vector<Recording>& recordings, const std::vector<Smoothed>& inputs, CableSettings& settings,
                   std::vector<std::string>& errors);

/// Stiffnesses and dampings, the length, what is stiff at the ends, and natural curvature at places along the cable about two
/// axes.
std::vector<Parameter> cable_parameters(const CableSettings& settings);

/// Where to begin: a straight cable of the measured length. `bending`: EI over the linear density [N m^3 / kg], `damping`: of
/// bending, likewise.
std::vector<double> first_guess(const CableSettings& settings, double bending, double damping);

/// The value that the scene's key has, out of the scale in which it is looked for.
double scene_value(const Parameter& parameter, double value);

/// The scene of a cable: materials, and the cable without `initial` and `attachments`.
SceneDesc cable_scene(const CableSettings& settings, const std::vector<double>& values);

}  // namespace verlet_cable::cable_fit

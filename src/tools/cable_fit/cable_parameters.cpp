#include "cable_parameters.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include "verlet_cable/core/number_text.h"

namespace verlet_cable::cable_fit {
namespace {

/// Errors are the same at 1 ms within a percent, see doc/real_cables.md.
constexpr double time_step = 0.01;  // [s]

/// A property of the material, in proportion to the cable's weight.
struct MaterialParameter {
  const char* key;
  const char* unit;
  double MaterialDesc::*member;
  double lowest, highest;  ///< decimal logarithms of the value over the linear density
};
constexpr MaterialParameter material_parameters[] = {
    {"bending_stiffness", "N m^2", &MaterialDesc::bending_stiffness, -5, 2},
    {"bending_damping", "N m^2 s", &MaterialDesc::bending_damping, -7, 0},
    {"drag", "kg/(m s)", &MaterialDesc::drag, -4, 2},
    {"torsional_stiffness", "N m^2", &MaterialDesc::torsional_stiffness, -5, 2},
};
constexpr std::size_t bending_index = 0, torsion_index = 3;
constexpr std::size_t length_index = std::size(material_parameters);
constexpr std::size_t stiff_index = length_index + 1;
constexpr std::size_t curvature_index = stiff_index + 2;

/// Torsional over bending stiffness is between 2/3 and 1 of round solid sections, and not far from it of others.
constexpr double likely_torsion = 0.5;  // decades
/// Curvature is looked for at so many places: about as far apart as markers are.
constexpr int curvature_places = 12;
constexpr double highest_curvature = 100;  // [1/m]
constexpr double likely_curvature = 1.5;   // [1/m]
/// The part of the measured length by which the effective one may differ.
constexpr double length_tolerance = 0.015;
/// A hand holds about as much as lies between its two markers; but the second may sit where the cable bends already, or a sleeve
/// may reach further.
constexpr double likely_stiff = 0.02;   // [m] from what lies between them
constexpr double longest_stiff = 0.05;  // of the cable's length
/// A scene is an error where the markers at its start are 5 % longer or shorter than the cable; rounding stays inside.
constexpr double start_tolerance = 0.0499;

/// What the simulation leaves unsolved in a step is far below what these change.
constexpr double logarithmic_step = 0.02;  // decades
constexpr double relative_length_step = 5e-4;
constexpr double stiff_step = 0.002;     // [m]
constexpr double curvature_step = 0.05;  // [1/m]
constexpr double guessed_drag = 0.1;     // [1/s] over the linear density

double first_length(const Recording& recording) {
  double length = 0;
  const std::vector<Vector3>& markers = recording.markers.front();
  for (std::size_t i = 1; i < markers.size(); ++i) length += (markers[i] - markers[i - 1]).norm();
  return length;
}

/// Distances of the first and of the last two markers.
std::array<double, 2> held_lengths(const std::vector<Smoothed>& inputs) {
  std::vector<double> first, last;
  for (const Smoothed& input : inputs) {
    for (const std::vector<Vector3>& markers : input.recording.markers) {
      first.push_back((markers[1] - markers[0]).norm());
      last.push_back((markers[markers.size() - 1] - markers[markers.size() - 2]).norm());
    }
  }
  return {median(first), median(last)};
}

double expected_stiff(const CableSettings& settings, int end) {
  return std::min(settings.held[end], longest_stiff * settings.length);
}

}  // namespace

std::vector<double> marker_places(const std::vector<Smoothed>& inputs, const std::vector<int>& which) {
  std::vector<const Recording*> recordings;
  for (const int i : which) recordings.push_back(&inputs[i].recording);
  return marker_places(recordings);
}

void measure_cable(const std::vector<Recording>& recordings, const std::vector<Smoothed>& inputs, CableSettings& settings,
                   std::vector<std::string>& errors) {
  std::vector<double> lengths;
  for (const Smoothed& input : inputs) lengths.push_back(measured_length(input.recording));
  settings.length = median(lengths);
  settings.held = held_lengths(inputs);
  std::vector<int> all(inputs.size());
  std::iota(all.begin(), all.end(), 0);
  settings.marker_places = marker_places(inputs, all);
  settings.shortest = (1 - length_tolerance) * settings.length;
  settings.longest = (1 + length_tolerance) * settings.length;
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    const double first = first_length(recordings[i]), smooth = first_length(inputs[i].recording);
    const double shorter = std::min(first, smooth), longer = std::max(first, smooth);
    if (longer > (1 + start_tolerance) * settings.length || shorter < (1 - start_tolerance) * settings.length)
      errors.push_back(recordings[i].path + ": the markers' distances in the first row are " + number_text(first) +
                       " m in all; allowed: at most 5 % more or less than the cable's length, measured as " +
                       number_text(settings.length) + " m");
    settings.shortest = std::max(settings.shortest, longer / (1 + start_tolerance));
    settings.longest = std::min(settings.longest, shorter / (1 - start_tolerance));
  }
}

std::vector<Parameter> cable_parameters(const CableSettings& settings) {
  std::vector<Parameter> parameters;
  const double density = std::log10(settings.linear_density);
  for (const MaterialParameter& p : material_parameters)
    parameters.push_back({"materials." + settings.name + "." + p.key, p.unit, true, density + p.lowest, density + p.highest,
                          logarithmic_step, 0, -1});
  parameters[torsion_index].likely = likely_torsion;
  parameters[torsion_index].relative_to = bending_index;
  parameters.push_back(
      {"cables[0].length", "m", false, settings.shortest, settings.longest, relative_length_step * settings.length, 0, -1});
  for (int end = 0; end < 2; ++end)
    parameters.push_back({"cables[0].stiff_ends[" + std::to_string(end) + "]", "m", false, 0, longest_stiff * settings.length,
                          stiff_step, likely_stiff, -1, expected_stiff(settings, end)});
  for (int i = 0; i < curvature_places; ++i) {
    for (int axis = 0; axis < 2; ++axis)
      parameters.push_back({"cables[0].rest_curvature[" + std::to_string(i) + "][" + std::to_string(axis) + "]", "1/m", false,
                            -highest_curvature, highest_curvature, curvature_step, likely_curvature, -1});
  }
  return parameters;
}

std::vector<double> first_guess(const CableSettings& settings, double bending, double damping) {
  const double density = settings.linear_density;
  std::vector<double> values{std::log10(bending * density),
                             std::log10(damping * density),
                             std::log10(guessed_drag * density),
                             std::log10(bending * density),
                             std::clamp(settings.length, settings.shortest, settings.longest),
                             expected_stiff(settings, 0),
                             expected_stiff(settings, 1)};
  values.resize(curvature_index + 2 * curvature_places, 0.0);
  return values;
}

double scene_value(const Parameter& parameter, double value) {
  return parameter.logarithmic ? std::pow(10, value) : value;
}

SceneDesc cable_scene(const CableSettings& settings, const std::vector<double>& values) {
  SceneDesc scene;
  scene.time_step = time_step;
  NamedMaterial& material = scene.materials.emplace_back();
  material.name = settings.name;
  material.material.linear_density = settings.linear_density;
  material.material.radius = settings.radius;
  for (std::size_t i = 0; i < length_index; ++i) material.material.*material_parameters[i].member = std::pow(10, values[i]);
  CableDesc& cable = scene.cables.emplace_back();
  cable.name = settings.name;
  cable.material = settings.name;
  cable.segments = settings.segments;
  cable.length = values[length_index];
  cable.stiff_ends = {values[stiff_index], values[stiff_index + 1]};
  cable.rest_curvature.type = RestCurvatureDesc::Type::profile;
  for (std::size_t i = curvature_index; i < values.size(); i += 2)
    cable.rest_curvature.profile.push_back({values[i], values[i + 1]});
  return scene;
}

}  // namespace verlet_cable::cable_fit

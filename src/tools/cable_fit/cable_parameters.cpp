#include "cable_parameters.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>
#include <utility>

#include "start.h"
#include "verlet_cable/core/number_text.h"

namespace verlet_cable::cable_fit {
namespace {

/// Errors are the same at 1 ms within a percent.
constexpr double time_step = 0.01;  // [s]

/// A property of the material, in proportion to the cable's weight.
struct MaterialParameter {
  const char* key;
  const char* unit;
  void (*set)(MaterialDesc& material, double value);
  double lowest, highest;  ///< decimal logarithms of the value over the linear density
};
constexpr MaterialParameter material_keys[] = {
    {"bending_stiffness", "N m^2", [](MaterialDesc& m, double value) { m.bending_stiffness = value; }, -5, 2},
    {"bending_damping", "N m^2 s", [](MaterialDesc& m, double value) { m.bending_damping = value; }, -7, 0},
    {"drag", "kg/(m s)", [](MaterialDesc& m, double value) { m.drag = value; }, -4, 2},
    {"torsional_stiffness", "N m^2", [](MaterialDesc& m, double value) { m.torsional_stiffness = value; }, -5, 2},
};
constexpr std::size_t bending_index = 0, drag_index = 2, torsion_index = 3;
constexpr std::size_t length_index = std::size(material_keys);
constexpr std::size_t stiff_index = length_index + 1;
constexpr std::size_t curvature_index = stiff_index + 2;

/// Torsional over bending stiffness is between 2/3 and 1 of round solid sections, and not far from it of others.
constexpr double likely_torsion = 0.5;  // decades
/// Curvature is looked for at so many places: about as far apart as markers are.
constexpr int curvature_places = 12;
constexpr double highest_curvature = 100;  // [1/m]
constexpr double likely_curvature = 1.5;   // [1/m]
/// The part of the measured length by which the effective one may differ.
constexpr double length_tolerance = 0.02;
/// So little told drag does not drift to where it has no effect.
constexpr double likely_drag = 2;  // decades
/// A hand holds about as much as lies between its two markers; but the second may sit where the cable bends already, or a sleeve
/// may reach further.
constexpr double likely_stiff = 0.3;                          // decades
constexpr double shortest_stiff = 1e-4, longest_stiff = 0.1;  // of the cable's length

/// Markers are stuck on from outside, grippers are thicker than cables.
constexpr double likely_hand_offset = 0.01, likely_marker_offset = 0.005;  // [m]
constexpr double likely_shift = 0.003;                                     // [m] of markers along the cable
constexpr double farthest_offset = 0.1, farthest_shift = 0.02;             // [m]

/// What the simulation leaves unsolved in a step is far below what these change.
constexpr double logarithmic_step = 0.02;  // decades
constexpr double relative_length_step = 5e-4;
constexpr double curvature_step = 0.05;  // [1/m]
constexpr double offset_step = 0.001;    // [m]
constexpr double guessed_drag = 0.1;     // [1/s] over the linear density

/// What a simulation with twice the segments and half the time step finds otherwise than a finer one: of materials, of what is
/// stiff, which is part of a segment, and of the length.
constexpr double unresolved_material = 0.005, unresolved_stiff = 0.02;  // decades
constexpr double unresolved_length = 1e-3;                              // of it; cables stretch a little

constexpr std::size_t marker_index = curvature_index + 2 * curvature_places;

double first_length(const Recording& recording) {
  return distances_along(recording.markers.front()).back();
}

/// [m] the start, as it is and smoothed: shorter and longer one.
std::pair<double, double> first_lengths(const Recording& recording, const Smoothed& input) {
  return std::minmax({first_length(recording), first_length(input.recording)});
}

/// Distances of the first and of the last two markers.
std::array<double, 2> held_lengths(const std::vector<const Recording*>& recordings) {
  std::vector<double> first, last;
  for (const Recording* recording : recordings) {
    for (const std::vector<Vector3>& markers : recording->markers) {
      first.push_back((markers[1] - markers[0]).norm());
      last.push_back((markers[markers.size() - 1] - markers[markers.size() - 2]).norm());
    }
  }
  return {median(first), median(last)};
}

void add_marker_parameters(const CableSettings& settings, std::vector<Parameter>& parameters) {
  for (int end = 0; end < 2; ++end)
    for (int axis = 1; axis <= 2; ++axis)
      parameters.push_back({"cables[0].attachments[" + std::to_string(end) + "].offset[" + std::to_string(axis) + "]", "m", false,
                            -farthest_offset, farthest_offset, offset_step, likely_hand_offset});
  for (std::size_t i = 2; i + 2 < settings.marker_places.size(); ++i) {
    const std::string marker = "markers[" + std::to_string(i) + "].";
    for (int axis = 1; axis <= 2; ++axis)
      parameters.push_back({marker + "offset[" + std::to_string(axis) + "]", "m", false, -farthest_offset, farthest_offset,
                            offset_step, likely_marker_offset});
    parameters.push_back({marker + "shift", "m", false, -farthest_shift, farthest_shift, offset_step, likely_shift});
  }
}

/// [m] the shortest and the longest one, whatever the starts.
std::pair<double, double> likely_lengths(const CableSettings& settings) {
  return {(1 - length_tolerance) * settings.length, (1 + length_tolerance) * settings.length};
}

/// In its scale, which ends above zero.
double expected_stiff(const CableSettings& settings, int end) {
  return std::log10(std::clamp(settings.held[end], shortest_stiff * settings.length, longest_stiff * settings.length));
}

}  // namespace

void measure_cable(const std::vector<Recording>& recordings, const std::vector<Smoothed>& inputs, const std::vector<int>& which,
                   CableSettings& settings) {
  std::vector<const Recording*> measured;
  std::vector<double> lengths;
  for (const int i : which) {
    measured.push_back(&inputs[i].recording);
    lengths.push_back(measured_length(inputs[i].recording));
  }
  settings.length = median(lengths);
  settings.held = held_lengths(measured);
  settings.usual_directions = usual_directions(measured);
  settings.marker_places = marker_places(measured);
  std::tie(settings.shortest, settings.longest) = likely_lengths(settings);
  for (const int i : which) {
    const auto [shorter, longer] = first_lengths(recordings[i], inputs[i]);
    settings.shortest = std::max(settings.shortest, longer / (1 + start_tolerance));
    settings.longest = std::min(settings.longest, shorter / (1 - start_tolerance));
  }
  if (settings.shortest > settings.longest) std::swap(settings.shortest, settings.longest);
}

void check_starts(const std::vector<Recording>& recordings, const std::vector<Smoothed>& inputs, const CableSettings& settings,
                  std::vector<std::string>& errors) {
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    const auto [shorter, longer] = first_lengths(recordings[i], inputs[i]);
    if (longer > (1 + start_tolerance) * settings.length || shorter < (1 - start_tolerance) * settings.length)
      errors.push_back(recordings[i].path + ": the markers' distances in the first row are " +
                       rounded_text(first_length(recordings[i])) +
                       " m in all; allowed: at most 5 % more or less than the cable's length, measured as " +
                       rounded_text(settings.length) + " m");
  }
}

std::vector<Parameter> material_parameters(const std::string& key, double linear_density) {
  std::vector<Parameter> parameters;
  const double density = std::log10(linear_density);
  for (const MaterialParameter& p : material_keys)
    parameters.push_back({key + "." + p.key, p.unit, true, density + p.lowest, density + p.highest, logarithmic_step, 0, -1});
  parameters[drag_index].likely = likely_drag;
  parameters[drag_index].expected = density + std::log10(guessed_drag);
  parameters[torsion_index].likely = likely_torsion;
  parameters[torsion_index].relative_to = bending_index;
  for (Parameter& parameter : parameters) parameter.unresolved = unresolved_material;
  return parameters;
}

void set_material(const std::vector<double>& values, std::size_t count, MaterialDesc& material) {
  for (std::size_t i = 0; i < count; ++i) material_keys[i].set(material, std::pow(10, values[i]));
}

std::vector<double> first_material(double linear_density, double bending, double damping) {
  return {std::log10(bending * linear_density), std::log10(damping * linear_density), std::log10(guessed_drag * linear_density),
          std::log10(bending * linear_density)};
}

std::vector<Parameter> cable_parameters(const CableSettings& settings) {
  std::vector<Parameter> parameters = material_parameters("materials." + settings.name, settings.linear_density);
  // A centre line starts along a smooth curve, which is not shorter than the cable.
  const auto [shortest, longest] =
      settings.centre_line ? likely_lengths(settings) : std::pair(settings.shortest, settings.longest);
  parameters.push_back({"cables[0].length", "m", false, shortest, longest, relative_length_step * settings.length, 0, -1});
  for (int end = 0; end < 2; ++end)
    parameters.push_back({"cables[0].stiff_ends[" + std::to_string(end) + "]", "m", true,
                          std::log10(shortest_stiff * settings.length), std::log10(longest_stiff * settings.length),
                          logarithmic_step, likely_stiff, -1, expected_stiff(settings, end)});
  for (int i = 0; i < curvature_places; ++i) {
    for (int axis = 0; axis < 2; ++axis)
      parameters.push_back({"cables[0].rest_curvature[" + std::to_string(i) + "][" + std::to_string(axis) + "]", "1/m", false,
                            -highest_curvature, highest_curvature, curvature_step, likely_curvature, -1});
  }
  parameters[length_index].unresolved = unresolved_length * settings.length;
  for (std::size_t i = stiff_index; i < curvature_index; ++i) parameters[i].unresolved = unresolved_stiff;
  for (std::size_t i = curvature_index; i < marker_index; ++i) parameters[i].has_common_width = true;
  if (settings.centre_line) add_marker_parameters(settings, parameters);
  return parameters;
}

std::vector<double> first_guess(const CableSettings& settings, double bending, double damping) {
  std::vector<double> values = first_material(settings.linear_density, bending, damping);
  values.insert(values.end(), {std::clamp(settings.length, settings.shortest, settings.longest), expected_stiff(settings, 0),
                               expected_stiff(settings, 1)});
  values.resize(marker_index, 0.0);
  return values;
}

std::vector<double> with_markers_on_line(const CableSettings& settings, std::vector<double> values) {
  values.resize(cable_parameters(settings).size(), 0.0);
  return values;
}

Markers markers_of(const CableSettings& settings, const std::vector<double>& values) {
  Markers markers{settings.marker_places, {}, settings.usual_directions, settings.held};
  if (!settings.centre_line) return markers;
  const std::size_t count = markers.places.size();
  markers.offsets.resize(count);
  // A hand holds the cable where its markers do not: they are off the other way.
  auto value = values.begin() + marker_index;
  for (const std::array<std::size_t, 2>& on_hand : {std::array<std::size_t, 2>{0, 1}, {count - 2, count - 1}}) {
    for (int axis = 0; axis < 2; ++axis, ++value)
      for (const std::size_t marker : on_hand) markers.offsets[marker][axis] = -*value;
  }
  for (std::size_t i = 2; i + 2 < count; ++i) {
    for (int axis = 0; axis < 2; ++axis) markers.offsets[i][axis] = *value++;
    markers.places[i] += *value++ / settings.length;
  }
  return markers;
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
  set_material(values, length_index, material.material);
  CableDesc& cable = scene.cables.emplace_back();
  cable.name = settings.name;
  cable.material = settings.name;
  cable.segments = settings.segments;
  cable.length = values[length_index];
  cable.stiff_ends = {std::pow(10, values[stiff_index]), std::pow(10, values[stiff_index + 1])};
  cable.rest_curvature.type = RestCurvatureDesc::Type::profile;
  cable.rest_curvature.zero_counts = true;
  for (std::size_t i = curvature_index; i < marker_index; i += 2)
    cable.rest_curvature.profile.push_back({values[i], values[i + 1]});
  return scene;
}

}  // namespace verlet_cable::cable_fit

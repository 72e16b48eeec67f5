#pragma once

#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "cable_fit/errors_in_variables.h"
#include "cable_fit/least_squares.h"
#include "explicit_rod.h"

namespace verlet_cable::cable_fit {

/// A recording of an explicit rod, without noise.
inline Recording recording_of_rod(unsigned seed, double pace, double duration, int segments) {
  const explicit_rod::Motion motion(seed, pace);
  Recording recording;
  recording.path = "take" + std::to_string(seed);
  for (const std::vector<explicit_rod::Vector>& row : explicit_rod::record({}, motion, duration, segments)) {
    recording.times.push_back(0.01 * static_cast<double>(recording.times.size()));
    std::vector<Vector3>& markers = recording.markers.emplace_back();
    for (const explicit_rod::Vector& marker : row) markers.emplace_back(marker.x, marker.y, marker.z);
  }
  return recording;
}

/// The same as a camera with noise [m] sees it.
inline Recording with_noise(Recording recording, double noise, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> scatter(0, 1);
  for (std::vector<Vector3>& markers : recording.markers)
    for (Vector3& marker : markers)
      for (int axis = 0; axis < 3; ++axis) marker[axis] += noise * scatter(random);
  return recording;
}

/// What is found of a rod: first by what predicts best, then by what is most likely true.
struct FoundRod {
  std::vector<Parameter> parameters;
  std::vector<double> predicting;
  Estimate estimate;
};

/// By a fit that begins at twice or half the rod's stiffness, not at the end of a long search.
inline FoundRod find_rod(const std::vector<Recording>& recordings, int segments) {
  constexpr int few_segments = 24;
  constexpr double bending = 3e-2, damping = 1e-4;
  std::vector<Smoothed> inputs;
  for (const Recording& recording : recordings) inputs.push_back(smoothed(recording));
  CableSettings settings;
  settings.name = "found";
  settings.segments = std::min(segments, few_segments);
  settings.linear_density = explicit_rod::Material().linear_density;
  std::vector<int> all(recordings.size());
  std::iota(all.begin(), all.end(), 0);
  measure_cable(recordings, inputs, all, settings);
  const Problem few{recordings, inputs, settings, cable_parameters(settings), [] {}};
  const std::vector<double> predicting = fit(few, all, first_guess(settings, bending, damping), for_predictions);
  settings.segments = segments;
  const Problem problem{recordings, inputs, settings, cable_parameters(settings), [] {}};
  return {problem.parameters, predicting, with_input_errors(problem, all, predicting, for_parameters.corrections)};
}

/// The value of a parameter that the rod has: that of its curvatures is 0.
inline double value_of_rod(std::size_t parameter) {
  const explicit_rod::Material material;
  const double values[] = {std::log10(material.bending_stiffness),
                           std::log10(material.bending_damping),
                           std::log10(material.drag),
                           std::log10(material.torsional_stiffness),
                           explicit_rod::length,
                           std::log10(explicit_rod::held),
                           std::log10(explicit_rod::held)};
  return parameter < std::size(values) ? values[parameter] : 0;
}

}  // namespace verlet_cable::cable_fit

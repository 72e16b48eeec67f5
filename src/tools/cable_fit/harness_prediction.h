#pragma once

#include "harness_parameters.h"
#include "prediction.h"

namespace verlet_cable::cable_fit {

/// What a prediction of a harness starts from and what holds it: the recording with the places of held markers rid of flicker
/// (a marker that jumps away and back) and smoothed. The others are as recorded; but the first two rows no prediction sees them.
Smoothed harness_input(const Harness& harness, const Recording& recording);

/// Measures how branches leave their cables: their mean orientation in the first rows of some of the inputs, in the axes of the
/// material there. x is along the branch, y in the plane of both, away from the direction of the cable that it leaves. About the
/// trunk, the material's axes are turned so that the first branch is in their plane of x and y.
void measure_branches(const std::vector<Smoothed>& inputs, const std::vector<int>& which, HarnessSettings& settings);

/// Adds what holds the harness to its scene: clamps in frames of the same names, x along the cable.
void add_clamps(const HarnessSettings& settings, SceneDesc& scene);

/// Adds a line to `errors` for each recording and cable whose start does not go with the measured length.
void check_harness_starts(const std::vector<Recording>& recordings, const std::vector<Smoothed>& inputs, HarnessSettings settings,
                          std::vector<std::string>& errors);

/// Predicts a recording from the first two rows of its input and what holds the harness. Its material is turned about the trunk
/// as the branches say in the first row, and rigid junctions keep the angles that they have there.
Prediction predict_harness(const HarnessSettings& settings, int segments, const std::vector<double>& values,
                           const Recording& input);

}  // namespace verlet_cable::cable_fit

#pragma once

#include <vector>

#include "confidence.h"
#include "differences.h"

namespace verlet_cable::cable_fit {

/// What the recordings tell of the material.
struct Estimate {
  std::vector<double> values;          ///< a parameter, in its scale
  std::vector<Confidence> confidence;  ///< a parameter
  std::vector<double> marker_places;   ///< fractions of the length, along the cable as it bends
};

/// Goes on from what predicts some of the recordings best to what is most likely true: the motion of the hands and the start,
/// which are measured with noise, too, are estimated together with the parameters (errors in variables). Taken for exact, as a
/// fit for predictions takes them, their noise would be explained by stiffness, damping and drag. In so many steps at most.
Estimate with_input_errors(const Problem& problem, const std::vector<int>& recordings, std::vector<double> values,
                           int most_steps);

/// Largest number of recordings that this simulates.
int most_simulations_with_input_errors(const Problem& problem, const std::vector<int>& recordings, int most_steps);

}  // namespace verlet_cable::cable_fit

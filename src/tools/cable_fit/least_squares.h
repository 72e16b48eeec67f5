#pragma once

#include <vector>

#include "differences.h"

namespace verlet_cable::cable_fit {

/// Largest number of recordings that a fit to so many simulates.
int most_simulations(const Problem& problem, int recordings);

/// A search over coarse steps of stiffness and damping: where to begin. `training`: indices of recordings; a value a parameter.
std::vector<double> coarse_search(const Problem& problem, const std::vector<int>& training);

/// Finds the parameters that predict some of the recordings best, from those given: Levenberg-Marquardt (Ceres).
std::vector<double> fit(const Problem& problem, const std::vector<int>& training, std::vector<double> values);

}  // namespace verlet_cable::cable_fit

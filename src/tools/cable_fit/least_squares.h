#pragma once

#include <vector>

#include "differences.h"

namespace verlet_cable::cable_fit {

/// When a fit ends. It looks first with few segments, then refines with all of them. A round finds slopes, and goes as far as
/// they lead.
struct Ending {
  int rounds;        ///< at most, with few segments
  int refinements;   ///< rounds with all of them, at most
  double tolerance;  ///< relative change of the cost in a round
  int corrections;   ///< steps, at most, that estimate the errors of the inputs, too
};
/// Parameters move along where predictions hardly change: noise that predictions cannot know is most of the cost.
constexpr Ending for_parameters{10, 6, 1e-3, 6};
/// Fits that are only predicted with, and take most of the time.
constexpr Ending for_predictions{8, 1, 3e-3, 2};

/// Largest number of recordings that a fit to so many simulates.
int most_simulations(const Problem& problem, int recordings, const Ending& ending = for_parameters);

/// A search over coarse steps of stiffness and damping: where to begin. A violent recording is explained by more than one
/// stiffness at first sight: each valley among the guesses is followed a little, and the deepest one counts. `training`: indices
/// of recordings; a value a parameter.
std::vector<double> coarse_search(const Problem& problem, const std::vector<int>& training);

constexpr int coarse_segments = 16;  ///< of a search

/// Finds the parameters that predict some of the recordings best, from those given: Levenberg-Marquardt (Ceres).
std::vector<double> fit(const Problem& problem, const std::vector<int>& training, std::vector<double> values,
                        const Ending& ending = for_parameters);

}  // namespace verlet_cable::cable_fit

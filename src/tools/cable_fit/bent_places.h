#pragma once

#include <vector>

#include "prediction.h"

namespace verlet_cable::cable_fit {

/// The markers' places, as fractions of the length, with which a prediction's distances between neighbouring ones are as
/// measured: those along the chords cut the bends. `places`: by the measured distances; `predicted_places`: where predictions
/// have them.
std::vector<double> places_along(const std::vector<double>& places, const std::vector<double>& predicted_places,
                                 const std::vector<Prediction>& predictions);

}  // namespace verlet_cable::cable_fit

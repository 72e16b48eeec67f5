#pragma once

#include "recording.h"

namespace verlet_cable::cable_fit {

/// A recording without its camera's noise.
struct Smoothed {
  Recording recording;
  double noise = 0;  ///< [m] standard deviation of a coordinate, as far as it does not carry over from row to row
};

/// Smooths every coordinate over time: least squares with a penalty on third differences (Whittaker 1923, Eilers 2003), as strong
/// as generalized cross-validation finds best for the recording (Craven and Wahba 1979). Two markers with 2 mm of noise on a hand
/// give its direction to some degrees, and their shaking would be taken for motion: it is the input of a fit, not what is
/// compared.
Smoothed smoothed(const Recording& recording);

}  // namespace verlet_cable::cable_fit

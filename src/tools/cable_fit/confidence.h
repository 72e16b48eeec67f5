#pragma once

#include <vector>

#include "differences.h"

namespace verlet_cable::cable_fit {

/// How well the recordings tell a parameter.
struct Confidence {
  double half_width = 0;  ///< of its 95 % interval, in the scale in which it is looked for; infinite: they do not tell it
  bool told = false;      ///< the interval is small enough to mean something, or without 0, and the value not at its limit
};

/// One a parameter, of the values that were fitted to all recordings. The variance of what the recordings say is that between
/// parts of them, each of a second or more (a sandwich estimate): differences within a part are anything but independent.
std::vector<Confidence> confidence(const Problem& problem, const std::vector<double>& values);

}  // namespace verlet_cable::cable_fit

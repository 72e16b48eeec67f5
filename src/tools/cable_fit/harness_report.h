#pragma once

#include <string>

#include "harness_fit.h"

namespace verlet_cable::cable_fit {

/// The scene file: materials, cables with `attachments`, junctions; without `initial`. `recordings`: how many were fitted.
std::string harness_yaml(const HarnessFit& fit, std::size_t recordings);

/// --report: parameters with their intervals, errors a recording, fitted and left out.
std::string harness_json(const HarnessProblem& problem, const HarnessFit& fit);

/// A table for people.
std::string harness_text(const HarnessProblem& problem, const HarnessFit& fit);

}  // namespace verlet_cable::cable_fit

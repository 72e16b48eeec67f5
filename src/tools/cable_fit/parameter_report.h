#pragma once

#include <string>

#include "common/json.h"
#include "confidence.h"

namespace verlet_cable::cable_fit {

/// What a fit found of a parameter, as values of the scene's key: key, unit, value, interval, whether the data tell it.
tools::Json parameter_json(const Parameter& parameter, double value, const Confidence& confidence);

/// The same as a line for people.
std::string parameter_line(const Parameter& parameter, double value, const Confidence& confidence);

}  // namespace verlet_cable::cable_fit

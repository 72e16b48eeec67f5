#pragma once

#include <string>

#include "cloud_fit.h"

namespace verlet_cable::cable_fit {

/// The scene file: the material and the cable, without `initial` and `attachments`.
std::string clouds_yaml(const CloudProblem& problem, const CloudFit& fit);

/// --report: parameters with their intervals, the mean distance of the points from the surface, over time.
std::string clouds_json(const CloudProblem& problem, const CloudFit& fit);

/// A table for people.
std::string clouds_text(const CloudProblem& problem, const CloudFit& fit);

}  // namespace verlet_cable::cable_fit

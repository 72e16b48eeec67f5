#pragma once

#include <functional>
#include <vector>

#include "cloud.h"
#include "confidence.h"
#include "verlet_cable/core/scene_desc.h"
#include "verlet_cable/scene/motion.h"

namespace verlet_cable::cable_fit {

/// A scene as it was filmed, of which a cable's material and length are looked for.
struct CloudProblem {
  SceneDesc scene;  ///< as it is but for these
  int cable;        ///< index
  Motion motion;    ///< of its frames, at the clouds' times
  Clouds clouds;
  std::function<void()> simulated;  ///< called whenever the clouds' time was simulated, from one thread at a time
};

/// What a fit to clouds found.
struct CloudFit {
  std::vector<Parameter> parameters;
  std::vector<double> values;          ///< a parameter, in its scale
  std::vector<Confidence> confidence;  ///< a parameter
  SceneDesc scene;                     ///< with these values
  double mean_distance = 0;            ///< [m] of a point from the tube, on either side
  std::vector<double> mean_distances;  ///< likewise, a cloud
};

/// Largest number of times that fit_clouds() simulates the clouds' time.
int most_simulations(const CloudProblem& problem);

/// Finds the material and the length with which the points are nearest to the cable's surface: which point is where along the
/// cable is not known, so that each counts by its distance from the tube.
CloudFit fit_clouds(const CloudProblem& problem);

}  // namespace verlet_cable::cable_fit

#pragma once

#include <array>
#include <vector>

#include "cable_parameters.h"
#include "harness.h"

namespace verlet_cable::cable_fit {

/// What is given of a cable of a harness, or measured.
struct BranchMeasures {
  double length = 0;                       ///< [m] between its outer markers
  std::vector<double> places;              ///< of the markers along it, fractions of its length
  std::array<double, 2> stiff_ends{0, 0};  ///< [m] between the two markers on what holds an end
  /// Of a branch: its axes in those of the material of the cable that it leaves (see harness_prediction.h).
  Quaternion orientation = Quaternion::Identity();
};

/// What is given of a harness, or measured, not looked for.
struct HarnessSettings {
  Harness harness;
  int segments = 40;                      ///< of the trunk; those of branches are about as long
  std::vector<BranchMeasures> cables;     ///< as in the harness
  std::vector<Vector3> usual_directions;  ///< of what holds it, one a hold
};

/// Measures lengths and the usual directions of what holds the harness on some of the recordings; not the orientation of
/// branches.
void measure_harness(const std::vector<Recording>& recordings, const std::vector<Smoothed>& inputs, const std::vector<int>& which,
                     HarnessSettings& settings);

/// Of each cable stiffnesses and dampings and natural curvature at places along it about two axes, of the trunk its length, of
/// branches the linear density where that is not given. The materials of branches are likely to be like the trunk's.
std::vector<Parameter> harness_parameters(const HarnessSettings& settings);

/// Where to begin: straight cables of one material. `bending`: EI over the linear density [N m^3 / kg], `damping`: likewise.
std::vector<double> first_harness_guess(const HarnessSettings& settings, double bending, double damping);

/// How many segments a cable has where the trunk is to have `segments`: so many that what sits at its nodes is near where it
/// should be.
int segments_of(const HarnessSettings& settings, int cable, int segments);

/// The scene of a harness: materials, cables without `initial` and `attachments`, and junctions.
SceneDesc harness_scene(const HarnessSettings& settings, int segments, const std::vector<double>& values);

}  // namespace verlet_cable::cable_fit

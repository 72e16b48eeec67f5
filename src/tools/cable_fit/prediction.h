#pragma once

#include <vector>

#include "recording.h"
#include "verlet_cable/core/scene_desc.h"

namespace verlet_cable::cable_fit {

/// The scene of a fitted cable (`cable`: its materials, and the cable without `initial` and `attachments`), held and started as
/// it was in a recording: clamps at its ends, its nodes and their velocities by the first two rows.
SceneDesc scene_of(const SceneDesc& cable, const Recording& recording);

/// Where the markers are predicted to be.
struct Prediction {
  bool sound = true;                            ///< false: the simulation had to stop, and stays where it was last
  std::vector<std::vector<Vector3>> positions;  ///< [m] a row of the recording, a marker
};

/// Predicts a recording from its first two rows and what holds the cable, as cable_sim would; `marker_places`: fractions of the
/// cable's length. Throws SceneError where the cable cannot be.
Prediction predict(const SceneDesc& cable, const std::vector<double>& marker_places, const Recording& recording);

}  // namespace verlet_cable::cable_fit

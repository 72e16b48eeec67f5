#pragma once

#include <array>
#include <functional>
#include <vector>

#include "recording.h"
#include "scene/frame_source.h"
#include "verlet_cable/core/scene_desc.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable::cable_fit {

/// Where the markers sit.
struct Markers {
  std::vector<double> places;  ///< fractions of the cable's length
  /// [m] a marker, from the cable's centre line along the material's y and z axes; empty: they sit on it
  std::vector<std::array<double, 2>> offsets;
  HeldDirections usual_directions;  ///< of the hands; what roll of theirs offsets refer to
  std::array<double, 2> held;       ///< [m] between the two markers on each hand
};

/// The clamps that hold a cable's ends, in frames at the outer markers.
std::vector<AttachmentDesc> clamps(const Markers& markers);

/// Where the markers are predicted to be.
struct Prediction {
  bool sound = true;                            ///< false: the simulation had to stop, and stays where it was last
  std::vector<std::vector<Vector3>> positions;  ///< [m] a row of the recording, a marker
};

/// What a world with a motion of its frames makes of markers at some times [s] from its start. `markers`: where they are in it
/// now.
Prediction simulate(World& world, const FrameSource& frames, double time_step, const std::vector<double>& times,
                    const std::function<std::vector<Vector3>()>& markers);

/// Predicts a recording from its first two rows and what holds the cable, as cable_sim would. `cable`: its materials, and the
/// cable without `initial` and `attachments`. Without offsets it starts along the markers; with them along a smooth curve beside,
/// and the markers on the hands are where the hands are. A length that does not go with the start is brought within what a scene
/// allows. Throws SceneError where the cable cannot be.
Prediction predict(const SceneDesc& cable, const Markers& markers, const Recording& recording);

/// The same with ends that are held otherwise than the recording says, in roll for instance. `smooth_start`: along a smooth curve
/// through the markers in any case.
Prediction predict(const SceneDesc& cable, const Markers& markers, const Recording& recording, const HeldEnds& ends,
                   bool smooth_start);

/// What holds the cable of a recording, as `predict` takes it.
HeldEnds held_ends(const Markers& markers, const Recording& recording);

}  // namespace verlet_cable::cable_fit

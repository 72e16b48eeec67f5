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

/// A world with markers on its way. Copies go on alike.
class Course {
 public:
  using MarkersIn = std::function<std::vector<Vector3>(const World& world)>;
  /// `markers`: where they are in a world now.
  Course(World world, MarkersIn markers);

  /// Where the markers are [m] at a time [s] from the world's start, not before the one that was asked for last.
  std::vector<Vector3> at(double time, const FrameSource& frames);
  bool is_sound() const { return is_sound_; }  ///< false: the simulation had to stop, and stays where it was last

 private:
  World world_;
  MarkersIn markers_;
  std::vector<Vector3> positions_, before_;  // after and before the last step
  bool is_sound_ = true;
};

/// What a world with a motion of its frames makes of markers at some times [s] from its start.
Prediction simulate(Course course, const FrameSource& frames, const std::vector<double>& times);

/// A prediction, and how it came to some rows: where others go on that are the same until there.
struct Waypoints {
  std::vector<int> rows;  ///< ascending
  Prediction prediction;
  std::vector<Course> courses;  ///< one a row
};

/// Predicts a recording from its first two rows and what holds the cable, as cable_sim would. `cable`: its materials, and the
/// cable without `initial` and `attachments`. Without offsets it starts along the markers; with them along a smooth curve beside,
/// and the markers on the hands are where the hands are. A length that does not go with the start is brought within what a scene
/// allows. Throws SceneError where the cable cannot be.
Prediction predict(const SceneDesc& cable, const Markers& markers, const Recording& recording);

/// The same with ends that are held otherwise than the recording says, in roll for instance. `smooth_start`: along a smooth curve
/// through the markers in any case.
Prediction predict(const SceneDesc& cable, const Markers& markers, const Recording& recording, const HeldEnds& ends,
                   bool smooth_start);

/// The same, with the ways to some rows.
Waypoints predict_by(std::vector<int> rows, const SceneDesc& cable, const Markers& markers, const Recording& recording,
                     const HeldEnds& ends, bool smooth_start);

/// The same prediction as `predict`'s with ends that are held as they were up to `rows_ahead` rows after the given one of the
/// waypoints' rows, and with all else equal.
Prediction predict_on(const Waypoints& waypoints, std::size_t which, const SceneDesc& cable, const Markers& markers,
                      const Recording& recording, const HeldEnds& ends);
/// Between rows, motions are interpolated with a look at those around.
constexpr int rows_ahead = 3;

/// What holds the cable of a recording, as `predict` takes it.
HeldEnds held_ends(const Markers& markers, const Recording& recording);

}  // namespace verlet_cable::cable_fit

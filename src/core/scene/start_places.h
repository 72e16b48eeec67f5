#pragma once

#include <map>
#include <string>
#include <vector>

#include "verlet_cable/core/scene_desc.h"

namespace verlet_cable {

/// Where bodies without a pose, and junctions, begin that several cables hold.
struct StartPlaces {
  std::map<int, Pose> bodies;        ///< by index into SceneDesc::bodies
  std::map<int, Vector3> junctions;  ///< [m] by index into SceneDesc::junctions
  /// A line for each cable that does not reach, with its key, and the name of what it does not reach.
  std::vector<std::string> errors;
};

/// What holds cables, by name, as far as it is known; the fixed frame's name is empty.
struct KnownPoses {
  std::map<std::string, Pose> frames, bodies;
};

/// Whether a body begins where its own pose, or what holds it, says.
bool has_pose(const BodyDesc& body);

/// Whether a cable's shape says where a body without pose begins that hangs on it and on cables that hang by default.
bool places_bodies(const SceneDesc& scene, const CableDesc& cable);

/// What is looked for hangs at rest on its spans: the parts of cables between what holds them. A guide that stays on a cable is
/// an end of two spans, though the cable may slide there; a cable on a sheave, whose way is not a chord, and one whose shape is
/// given place nothing: bodies on them begin where their shapes put them. Of harnesses (see `harnesses_of`) all whose cables
/// `start`, a flag a cable: if they have bodies that several cables hold, or if `junctions_only` do not reach. A harness some
/// holder of which is not known has no places yet.
StartPlaces find_start_places(const SceneDesc& scene, const std::vector<char>& start, bool junctions_only,
                              const KnownPoses& known);

}  // namespace verlet_cable

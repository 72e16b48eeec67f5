#pragma once

#include <algorithm>
#include <vector>

#include "contact/segment_grid.h"
#include "verlet_cable/core/surface_point.h"
#include "world/state.h"

namespace verlet_cable {

/// Cables that may touch each other in a step, and bodies, with the cables that they hold: they are advanced in the same
/// substeps.
struct Island {
  std::vector<int> cables;  ///< indices into State::cables, ascending
  std::vector<int> bodies;  ///< that hold them, or each other; indices into State::bodies, ascending
  std::vector<int> held;    ///< attachments that hold those bodies, one body after the other; indices into State::attachments
  SegmentPairs pairs;       ///< of their segments
};

/// [kg] Of all its cables and bodies, with the water that these displace and that moves with them.
double mass_of(const Island& island, const State& state);

/// Whether cables may touch each other.
inline bool cables_touch(const SceneDesc& scene) {
  return scene.contact && scene.contact->between_cables;
}

/// Whether islands may be of more than one cable, or of cables and bodies that do not hold them.
inline bool are_islands_of_many(const SceneDesc& scene) {
  return cables_touch(scene) ||
         std::any_of(scene.bodies.begin(), scene.bodies.end(), [](const BodyDesc& body) { return !body.shapes.empty(); });
}

/// What cables are stepped together with. Follows from the state; islands whose cables stay the same keep their pairs.
class Islands {
 public:
  /// Every cable and every body is in one island, and those that may come close enough to touch in the next step, or that hold
  /// each other, are in the same one. KinematicTargets aim at the end of that step. Ascending by the first cable; those without
  /// cables come last.
  void build(const State& state);
  /// Segments have been numbered anew.
  void invalidate() { islands_.clear(); }
  std::vector<Island>& all() { return islands_; }
  std::size_t segments() const { return segments_; }  ///< of all cables

 private:
  void find_labels(const State& state);
  void find_reaches(const State& state);
  void join_by_bodies(const State& state);
  void join_touching_bodies(const State& state);
  void sort_into_islands(const State& state);
  void find_held(const State& state);
  bool come_close(const State& state, int first, int second);
  const std::vector<Aabb>& segment_reaches(const State& state, int cable);
  int root(int cable);
  void join(int first, int second);

  std::vector<Island> islands_;
  std::size_t segments_ = 0;
  std::vector<int> place_;        ///< by cable, then by body: which island it is in
  std::vector<int> labels_;       ///< by cable, then by body: the first one of its island
  std::vector<int> last_labels_;  ///< those of `islands_`
  // Scratch
  std::vector<double> margins_;                     ///< [m] by cable: so far from its segments it may touch something in the step
  std::vector<Aabb> reaches_;                       ///< by cable: where that is
  std::vector<std::vector<Aabb>> segment_reaches_;  ///< by cable: the same of its segments, halved again and again; or empty
  std::vector<int> order_, open_;
  std::vector<Aabb> body_reach_;  ///< of one body
};

}  // namespace verlet_cable

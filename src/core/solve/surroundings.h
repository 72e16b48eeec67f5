#pragma once

#include <vector>

#include "contact/moving_obstacle.h"
#include "target/kinematic_targets.h"
#include "verlet_cable/core/cable.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// How far a place of a cable is from something: gap [m] between the surfaces, and the normal out of what is there.
struct Clearance {
  double gap = infinity;
  Vector3 normal = Vector3::UnitZ();
  double fraction = 0;  ///< along the segment that is asked for
  int solid = 0;        ///< of what stands there
};

/// What stands where a cable is to come to rest, as contacts see it: what an attachment joins it to is not there next to that,
/// and held nodes touch nothing.
class Surroundings {
 public:
  Surroundings(const SimulatedCable& cable, const KinematicTargets& targets, const std::vector<Attachment>& attachments,
               const std::vector<MovingObstacle>& obstacles);

  int size() const { return static_cast<int>(solids_.size()); }
  /// Calls `f` with the clearance of a node from each obstacle that it touches, were it at `place` [m].
  template <class F>
  void touch_node(int node, const Vector3& place, const F& f) const {
    for (int k = 0; k < size(); ++k)
      if (Clearance c = of_node(solids_[k], node, place); c.gap < 0) {
        c.solid = k;
        f(c);
      }
  }
  /// The same of a segment from `start` to `end` [m]: where it is deepest, and not touched by as much as a smooth cable bulges
  /// out between nodes.
  template <class F>
  void touch_segment(int segment, const Vector3& start, const Vector3& end, const F& f) const {
    for (int k = 0; k < size(); ++k)
      if (Clearance c = of_segment(solids_[k], segment, start, end); c.gap < 0) {
        c.solid = k;
        f(c);
      }
  }
  /// Whether anything is touched, the nodes being there [m].
  bool touches(const std::vector<Vector3>& positions) const;
  /// The part of a segment's way that its centre line goes before it gets into something. Ways of its ends [m].
  double free_part(int segment, const Vector3& start, const Vector3& end, const Vector3& start_way, const Vector3& end_way) const;
  /// The same of a node's way.
  double free_part(int node, const Vector3& start, const Vector3& way) const;

 private:
  struct Solid {
    const MovingObstacle* moving = nullptr;
    Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
    std::vector<char> ignored;  ///< nodes and segments in turns
  };

  static double free_part_of(const Solid& solid, double radius, const Vector3& start, const Vector3& end,
                             const Vector3& start_way, const Vector3& end_way, double part);
  Clearance of_node(const Solid& solid, int node, const Vector3& place) const;
  Clearance of_segment(const Solid& solid, int segment, const Vector3& start, const Vector3& end) const;

  std::vector<double> radii_;  ///< [m] nodes and segments in turns
  std::vector<Solid> solids_;
};

}  // namespace verlet_cable

#pragma once

#include <vector>

#include "contact/cable_stretches.h"
#include "contact/cache.h"
#include "contact/contact_reach.h"
#include "contact/moving_obstacle.h"
#include "contact/pressed_lengths.h"
#include "contact/touched_place.h"
#include "geometry/part_over_face.h"
#include "target/kinematic_targets.h"
#include "verlet_cable/core/cable_materials.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// A cable whose contacts are looked for.
struct ContactMember {
  std::uint32_t id = 0;  ///< by which contacts name it
  const KinematicTargets* targets = nullptr;
  ContactCache* cache = nullptr;
};

/// Whether a point of a cable is close to where an attachment joins the cable to the obstacle's own frame.
bool is_anchored(const CableState& state, const KinematicTargets& targets, const CablePoint& point, const Obstacle& obstacle,
                 const std::vector<Attachment>& attachments);

/// Finds where a cable may touch obstacles and the shapes of bodies, one of them after the other.
class ObstacleTouches {
 public:
  /// The cable that is looked at from now on, until it changes; `index`: into World::cables().
  void begin(const SimulatedCable& cable, int index, const ContactMember& member, const std::vector<Attachment>& attachments);
  /// The shapes of a body, which come next. A cable that the body holds inside of them comes out of them as it likes.
  void enter_body(const MovingObstacle* first, const MovingObstacle* last);
  /// Adds the touches with one of them to a list: ascending by keys.
  void find(const MovingObstacle& moving, const ContactReach& reach, std::vector<Touch>& touches);
  /// What those that were found last, from the `first` on, share: the lengths that they press on, and the turn of the cable,
  /// which bounds their friction. They know what they were in the substep before.
  void share(std::size_t first, std::vector<Touch>& touches);

 private:
  /// How a touch shares the force of the law at its depth with others.
  struct Sharing {
    double share = 1;
    double node_distance = infinity;  ///< [m] of the node beside it from the surface, which has the rest
  };

  double reach_of(double radius, double speed) const;
  bool is_far(const Stretch& stretch) const;
  void meet(const MovingObstacle& moving, const ContactReach& reach);
  void visit(int node, double far);
  void add_node(int node, std::vector<Touch>& touches);
  void add_segment(int segment, double length, double far, std::vector<Touch>& touches);
  int add(const CablePoint& point, int place, Place where, const SurfacePoint& nearest, const Sharing& sharing,
          std::vector<Touch>& touches);
  void set_motion_of_body(const CablePoint& beside, Touch& touch) const;
  PressedPart pressed_at(int segment, double fraction) const;

  // Of the cable
  const SimulatedCable* cable_ = nullptr;
  int index_ = 0;
  const ContactMember* member_ = nullptr;
  const std::vector<Attachment>* attachments_ = nullptr;
  std::vector<char> held_;  ///< nodes
  CableStretches stretches_;
  bool has_sections_ = false;  ///< a material asks for the lengths that contacts press on
  // Of the body
  std::vector<char> inside_;  ///< of it, from where it holds the cable; nodes and segments in turns
  // Of the obstacle
  const MovingObstacle* moving_ = nullptr;
  const ContactReach* reach_ = nullptr;
  Eigen::Matrix3d orientation_ = Eigen::Matrix3d::Identity();
  bool has_edges_ = false;
  bool cuts_ = false;                  ///< segments touch, not only nodes
  std::vector<Vector3> local_;         ///< [m] nodes in its frame; of segments that are close to it
  std::vector<SurfacePoint> nearest_;  ///< on its surface; likewise
  std::vector<Vector3> feet_;          ///< [m] on its surface, in its frame, of each of the touches
  std::vector<std::size_t> pressed_;   ///< scratch
  std::vector<PressedPart> parts_;     ///< of a cable whose materials have sections
  std::vector<int> node_touches_;      ///< likewise, indices of touches; -1: none
};

}  // namespace verlet_cable

#pragma once

#include <vector>

#include "contact/cable_stretches.h"
#include "contact/cache.h"
#include "contact/moving_obstacle.h"
#include "contact/nearest_touches.h"
#include "contact/pressed_lengths.h"
#include "contact/segment_grid.h"
#include "target/kinematic_targets.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// What contacts are found with.
struct ContactRules {
  bool still = false;         ///< nothing moves but towards equilibrium, by less than a radius at a time
  double time_step = 0;       ///< [s] the world's
  SegmentGrid::Rules pairs;   ///< which cables touch which
  double cable_friction = 0;  ///< Coulomb coefficient of cable against cable
};

/// A cable whose contacts are looked for.
struct ContactMember {
  std::uint32_t id = 0;  ///< by which contacts name it
  const KinematicTargets* targets = nullptr;
  ContactCache* cache = nullptr;
};

/// [radii] By no more than this a smooth cable is taken to bulge out between two nodes.
constexpr double largest_bulge = 0.08;

/// Whether a point of a cable is close to where an attachment joins the cable to the obstacle's own frame.
bool is_anchored(const CableState& state, const KinematicTargets& targets, const CablePoint& point, const Obstacle& obstacle,
                 const std::vector<Attachment>& attachments);

/// The contacts of cables that are stepped together: found anew for every substep, but for what their caches keep.
class ContactSet {
 public:
  /// Finds what may touch in the next h [s]. `island`: ascending indices into `cables`; `members`: the same cables; `bodies`:
  /// shapes of bodies, likewise ascending; `pairs`: of the cables' segments, as the last call for them left it, or empty.
  void find(const std::vector<SimulatedCable>& cables, const std::vector<int>& island, const std::vector<ContactMember>& members,
            const std::vector<MovingObstacle>& obstacles, const std::vector<MovingObstacle>& bodies,
            const std::vector<Attachment>& attachments, const ContactRules& rules, double h, SegmentPairs& pairs);
  /// They are those of a substep that goes by another scheme than the conserving one, which `find` takes for granted.
  void follow_scheme(Scheme scheme, const std::vector<SimulatedCable>& cables, double h);
  /// The substep is done: the caches of the members take what sticks.
  void keep(const std::vector<ContactMember>& members) const;

  std::vector<Touch>& touches() { return touches_; }
  const std::vector<Touch>& touches() const { return touches_; }
  bool touched(std::size_t member) const { return touched_[member] != 0; }  ///< whether it is part of a touch
  bool touches_body(std::size_t member) const { return touches_body_[member] != 0; }
  /// Whether anything is pressed by something that it is inside of: that is no equilibrium, though it may not move.
  bool is_stuck() const;
  const std::vector<Intrusion>& intrusions() const { return intrusions_; }  ///< that `find` came upon

 private:
  void set_held(const SimulatedCable& cable, const KinematicTargets& targets, const std::vector<Attachment>& attachments);
  void find_bodies(const SimulatedCable& cable, int index, const ContactMember& member, const std::vector<MovingObstacle>& bodies,
                   const std::vector<Attachment>& attachments, double h);
  void set_inside(const SimulatedCable& cable, const KinematicTargets& targets, const MovingObstacle* first,
                  const MovingObstacle* last, const std::vector<Attachment>& attachments);
  void find_joined(const std::vector<Attachment>& attachments, const std::vector<ContactMember>& members);
  void find_obstacle(const SimulatedCable& cable, int index, const ContactMember& member, const MovingObstacle& moving,
                     const std::vector<Attachment>& attachments, double h);
  void find_pairs(const std::vector<SimulatedCable>& cables, const std::vector<ContactMember>& members, const SegmentPairs& found,
                  double thickest, double h);
  void look_at(const std::vector<SimulatedCable>& cables, const std::vector<ContactMember>& members,
               const SegmentPairs::Pair& pair, double speed, double h);
  void add_pair(const std::vector<SimulatedCable>& cables, const std::vector<ContactMember>& members, const NearPair& near,
                double h);
  void note(const Intrusion& found);
  void add(Touch& touch, const ContactMember& member, double h);
  double reach(double speed, double radius, double h) const;
  bool may_close(double gap, const Vector3& normal, const Vector3& velocity, double radius, double h) const;
  bool recall(const ContactMember& member, Touch& touch);

  SegmentGrid grid_;
  std::vector<JoinedNode> joined_;
  ContactRules rules_;
  double time_ = 0;  ///< [s] in which contacts come to rest
  std::vector<Touch> touches_;
  std::vector<Intrusion> intrusions_;
  std::vector<int> places_;             ///< among the members, by cable; set for these only
  std::vector<char> touched_;           ///< by member
  std::vector<char> touches_body_;      ///< likewise
  std::vector<std::size_t> recalled_;   ///< by member: the first of its cache that may still be asked for
  double thinnest_ = 0, shortest_ = 0;  ///< [m] radius, and segment at rest, of all that are found together
  std::vector<NearPair> near_;          ///< of one segment, with those after it; ascending
  // Nodes of one cable
  std::vector<char> held_;
  CableStretches stretches_;
  std::size_t first_of_cable_ = 0;     ///< of touches_: of the cable whose obstacles are looked for
  std::vector<char> inside_;           ///< of a body, from where that holds the cable; nodes and segments in turns
  std::vector<Vector3> local_;         ///< [m] in an obstacle's frame; of segments that are close to it
  std::vector<SurfacePoint> nearest_;  ///< on its surface; likewise
  std::vector<Vector3> feet_;          ///< [m] on its surface, in its frame, of each of the touches
  std::vector<std::size_t> pressed_;   ///< scratch
  // Of a cable whose materials have sections, on one obstacle
  std::vector<PressedPart> parts_;
  std::vector<int> node_touches_;  ///< indices into touches_; -1: none
};

}  // namespace verlet_cable

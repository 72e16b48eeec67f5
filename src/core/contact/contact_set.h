#pragma once

#include <vector>

#include "contact/contact_reach.h"
#include "contact/nearest_touches.h"
#include "contact/obstacle_touches.h"
#include "contact/segment_grid.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// What contacts are found with.
struct ContactRules {
  bool still = false;         ///< nothing moves but towards equilibrium, by less than a radius at a time
  double time_step = 0;       ///< [s] the world's
  SegmentGrid::Rules pairs;   ///< which cables touch which
  double cable_friction = 0;  ///< Coulomb coefficient of cable against cable
};

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
  void find_joined(const std::vector<Attachment>& attachments, const std::vector<ContactMember>& members);
  void find_obstacle(const SimulatedCable& cable, const ContactMember& member, const MovingObstacle& moving,
                     std::size_t first_of_cable, const ContactReach& reach);
  void find_pairs(const std::vector<SimulatedCable>& cables, const std::vector<ContactMember>& members, const SegmentPairs& found,
                  double thickest, const ContactReach& reach);
  void look_at(const std::vector<SimulatedCable>& cables, const std::vector<ContactMember>& members,
               const SegmentPairs::Pair& pair, double speed, const ContactReach& reach);
  void add_pair(const std::vector<SimulatedCable>& cables, const std::vector<ContactMember>& members, const NearPair& near,
                const ContactReach& reach);
  void note(const Intrusion& found);
  void start(Touch& touch, const ContactMember& member, const ContactReach& reach);
  bool recall(const ContactMember& member, Touch& touch);

  ObstacleTouches on_obstacle_;
  SegmentGrid grid_;
  std::vector<JoinedNode> joined_;
  ContactRules rules_;
  std::vector<Touch> touches_;
  std::vector<Intrusion> intrusions_;
  std::vector<int> places_;             ///< among the members, by cable; set for these only
  std::vector<char> touched_;           ///< by member
  std::vector<char> touches_body_;      ///< likewise
  std::vector<std::size_t> recalled_;   ///< by member: the first of its cache that may still be asked for
  double thinnest_ = 0, shortest_ = 0;  ///< [m] radius, and segment at rest, of all that are found together
  std::vector<NearPair> near_;          ///< of one segment, with those after it; ascending
};

}  // namespace verlet_cable

#pragma once

#include <vector>

#include "contact_law.h"
#include "segment_grid.h"
#include "verlet_cable/core/obstacle.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// An obstacle during a substep.
struct MovingObstacle {
  const Obstacle* obstacle = nullptr;
  int index = 0;     ///< into World::obstacles()
  Pose start, end;   ///< of its shape
  Aabb box;          ///< around it at the start, in the fixed frame [m]
  double speed = 0;  ///< [m/s] no point of it is faster
};

/// What contacts are found with.
struct ContactRules {
  bool still = false;         ///< nothing moves but towards equilibrium, by less than a radius at a time
  double time_step = 0;       ///< [s] the world's
  SegmentGrid::Rules pairs;   ///< which cables touch which
  double cable_friction = 0;  ///< Coulomb coefficient of cable against cable
};

/// What a contact takes from one substep to the next.
struct Sticking {
  std::uint64_t key = 0, other_key = 0;  ///< of the touch
  Vector3 force = Vector3::Zero();       ///< [N] friction of what sticks
  Touch::Mode mode = Touch::Mode::open;
  bool inside = false;
};

/// The contacts of a group of cables: found anew for every substep, but for what sticks.
class ContactSet {
 public:
  /// Finds what may touch in the next h [s]. `group`: ascending indices into `cables`.
  void find(const std::vector<SimulatedCable>& cables, const std::vector<int>& group,
            const std::vector<MovingObstacle>& obstacles, const std::vector<Attachment>& attachments, const ContactRules& rules,
            double h);
  /// Whether segments that touch have passed through each other since `find`.
  bool crossed(const std::vector<SimulatedCable>& cables) const;
  /// The substep is done: keeps what sticks.
  void keep();
  /// Nodes have been renumbered: nothing sticks any more.
  void forget();

  std::vector<Touch>& touches() { return touches_; }
  const std::vector<Touch>& touches() const { return touches_; }
  bool touched(int cable) const { return touched_[cable] != 0; }  ///< whether a cable is part of a touch
  const std::vector<Sticking>& sticking() const { return sticking_; }
  const std::vector<Intrusion>& intrusions() const { return intrusions_; }  ///< that `find` came upon

 private:
  void set_held(const SimulatedCable& cable, int index, const std::vector<Attachment>& attachments);
  void find_obstacle(const SimulatedCable& cable, int index, const MovingObstacle& moving,
                     const std::vector<Attachment>& attachments, double h);
  void find_pairs(const std::vector<SimulatedCable>& cables, double speed, double h);
  void add(Touch& touch, const Vector3& velocity, const Vector3& other, double h);
  double reach(double speed, double radius, double h) const;
  bool recall(Touch& touch);

  std::vector<Sticking> sticking_;  ///< ascending by keys
  // Scratch
  SegmentGrid grid_;
  ContactRules rules_;
  double time_ = 0;  ///< [s] in which contacts come to rest
  std::vector<Touch> touches_;
  std::vector<char> touched_;  ///< by cable
  std::vector<Intrusion> intrusions_;
  std::size_t recalled_ = 0;   ///< the first of `sticking_` that may still be asked for
  // Nodes of one cable
  std::vector<char> held_, visited_;
  std::vector<Vector3> local_;         ///< [m] in an obstacle's frame; where visited
  std::vector<SurfacePoint> nearest_;  ///< on its surface; where visited
};

}  // namespace verlet_cable

#pragma once

#include <vector>

#include "geometry/vector_array.h"
#include "target/boundary.h"
#include "verlet_cable/core/cable.h"

namespace verlet_cable {

/// How the material of a cable without frames spins about its segments' directions, one a segment [rad/s]: it twists as under one
/// torque between clamps that pass their roll on, not at all beyond them. Where there are none it spins as it has to bend least:
/// bending that only turns with the material is not damped.
class MaterialSpin {
 public:
  void resize(int segments);
  /// `segment`: [m]; `damping`: what resists bending, a node; `h`: the substep [s].
  void find(const CableModel& model, const CableState& state, const VectorArray& segment,
            const std::vector<HeldDirection>& directions, const std::vector<double>& damping, double h);
  /// Whether clamps turn the material: there are some, and it passes their roll on.
  bool is_driven() const { return shares_.front().first >= 0; }
  /// [rad/s] At a joint between two segments: as clamps turn the material in this substep.
  double driven(int node) const { return 0.5 * (driven_[node - 1] + driven_[node]); }
  /// [rad/s] Likewise, what directions that turn make of it, as they did in the substep before.
  double own(int node) const { return 0.5 * (own_[node - 1] + own_[node]); }
  /// Adds what a torque on the joint [N m], about the cable, is on the holders of the clamps that turn it.
  void pass_on(int node, double torque, std::vector<HeldDirection>& directions) const;

 private:
  /// Which clamps turn a segment, and by how much of it the second one does; -1: none.
  struct Share {
    int first = -1, last = -1;
    double of_last = 0;
  };
  void find_own(const CableState& state, const VectorArray& segment, const std::vector<double>& damping, double h);
  void turn_with_clamps(int first, int last, int from, int to, const CableModel& model, const CableState& state,
                        const std::vector<HeldDirection>& directions, double h);

  double common_ = 0;  // [rad/s] with which a part that nothing turns has to bend least
  std::vector<double> own_, driven_;
  std::vector<Share> shares_;
};

/// Of a direction that is held [rad/s], about itself.
double spin_of(const HeldDirection& target, double h);

/// By what e, the change of direction at a node, turns with the material, a radian.
inline Vector3 turn_of(const Vector3& before, const Vector3& after, const Vector3& e) {
  return (before + after).normalized().cross(e);
}

}  // namespace verlet_cable

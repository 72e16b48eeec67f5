#pragma once

#include <vector>

#include "lanes/passes.h"
#include "rod/cable_stepper.h"
#include "rod/clamp_joint.h"
#include "rod/node_elimination.h"
#include "rod/substep.h"

namespace verlet_cable {

/// A substep of a cable that may be stepped together with others.
struct LaneMember {
  Substep substep;
  CableState* state = nullptr;
  SubstepResult result;
};

/// Whether a cable can be stepped in lanes: straight isotropic ones can, as long as they move as in conserving substeps and
/// nothing acts on them that has a law of its own (twist, fluids, winches). The substep's boundary need not be known.
bool fits_lanes(const Substep& substep, const CableState& state, bool is_held);

/// [J] Of the nodes that nothing holds.
double kinetic_energy_of_free(const LaneMember& member);

/// Those of equal laws can be stepped together.
LaneLaw law_of(const Substep& substep, const CableState& state);

/// The lanes of the widest numbers that this processor computes with: 2, 4 or 8.
int widest_lanes();

/// Advances several cables at once, as CableStepper does one, by conserving substeps. A cable's numbers are the same whatever it
/// is stepped together with, and in lanes of any width.
class LaneStepper {
 public:
  /// Of up to widest / 2 cables that fit, of equal laws. A state is untouched where its result has not converged. `cleaner` takes
  /// out motion that the substep has not resolved.
  void advance(std::vector<LaneMember>& members, int widest, CableStepper& cleaner);

 private:
  /// A segment as its lanes have it: one, or where they meet both.
  template <class Operation>
  void each_lane_of(int cable, int segment, const Operation& operation);

  void choose_passes(std::size_t cables, int widest);
  void resize(const LaneLaw& law);
  void load(std::vector<LaneMember>& members);
  void set_cable(int place, LaneMember& member);
  void set_values(int cable, const LaneMember& member);
  void set_damping(int cable, const LaneMember& member);
  void turn_with_material(int cables);
  void read_displacement(int cable);
  void set_pad(int cable);
  void set_ends(int cable, const LaneMember& member);
  void hold(int cable, const LaneMember& member);
  void bend_clamps(int cable, const LaneMember& member);
  void iterate(std::vector<LaneMember>& members);
  void react(int cable, LaneMember& member);
  void react_to_projection(int cable, LaneMember& member);
  Vector3 impulse_on(int cable, int node);
  void scale_to_lose(int cable, const LaneMember& member);
  void set_held_accelerations(int cable, const LaneMember& member);
  bool leaves_unresolved(int cable, const LaneMember& member) const;
  void complete(int cable, LaneMember& member);
  void balance_laws(int cable, LaneMember& member);
  void balance_drag(LaneMember& member);
  void balance_stretching(LaneMember& member);
  void balance_compliance(LaneMember& member);
  double kinetic_energy_before_mending(int cable, const LaneMember& member);
  double& value(LaneField field, int place, int lane);
  double& at(LaneField field, int cable, int node);
  Vector3 vector_at(LaneField first, int cable, int node);
  void set_vector_at(LaneField first, int cable, int node, const Vector3& vector);
  Vector3 segment_at(LaneField first, int cable, int segment);
  Vector3 joint_moment(int cable, int node);
  Vector3 direction_change(int cable, int node);
  Vector3 over_length(int cable, int segment, const Vector3& vector);
  Vector3 force_of(int cable, int segment);

  /// The widest number. Arrays of it are aligned for narrower ones as well.
  struct alignas(64) Block {
    double values[most_lanes];
  };
  using Array = std::vector<Block>;
  LanePasses passes_{};
  LaneWork work_;
  LaneValues values_{};
  std::vector<LaneCable> cables_;
  std::vector<MiddleElimination> middles_;
  std::vector<Convergence> convergences_;
  std::vector<std::vector<ClampJoint>> clamps_;         // a cable
  std::vector<Bending> bendings_;                       // a cable; what of its bending is damped
  std::vector<std::vector<double>> start_multipliers_;  // a cable, a segment [N]; empty where nothing is to be cleaned
  VectorArray segments_;                                // of one cable, at the start of the substep [m]
  VectorArray displacement_;                            // likewise, of the nodes over the substep [m]
  Array records_, eliminations_;
};

template <class Operation>
void LaneStepper::each_lane_of(int c, int segment, const Operation& operation) {
  if (segment <= work_.lane) operation(segment, 2 * c, 1.0);
  if (segment >= work_.lane) operation(work_.last_node - 1 - segment, 2 * c + 1, -1.0);
}

}  // namespace verlet_cable

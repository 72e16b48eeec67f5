#pragma once

#include <vector>

#include "guide/flow.h"
#include "law/bend.h"
#include "rod/block_elimination.h"
#include "rod/clamp_joint.h"
#include "rod/material_spin.h"
#include "target/boundary.h"
#include "verlet_cable/core/cable.h"

namespace verlet_cable {

/// The bending of a cable that is straight unloaded and bends alike about all axes, over a substep: moments between neighbouring
/// segments, averaged so that energy and momentum are conserved. Of all others see KirchhoffRod.
///
/// At node i it is that of law/bend.h, e = d_i / l_i - d_(i-1) / l_(i-1) being the change of direction. At a clamp the frame's
/// axis stands for one of the two directions, half a segment away; it is as long as the segment is stretched, so that a clamp
/// does not resist stretch.
///
/// Damping resists the change of e in the material, which spins as MaterialSpin says: see BendDamping.
class Bending {
 public:
  void resize(int segments);
  int segments() const { return segments_; }
  /// `segment`: the segments at the start of the substep [m]; `part`: where in the substep forces are taken, 1/2 or 1.
  void start(const CableModel& model, const CableState& state, const VectorArray& segment,
             const std::vector<HeldDirection>& directions, double h, double part);
  bool active() const { return active_; }
  /// After `start`, where material flows through guides; the segments at the start [m].
  void start_flows(const CableState& state, const VectorArray& segment, const std::vector<GuidedFlow>& flows);
  /// Before the ways of all flows are added: from segment `before` to segment `after`, by `way` [m] in the substep.
  void forget_flows();
  void add_flow(int before, int after, double way);
  /// What of the energy drives such a flow [N], for the forces that `add_segment_forces` found last. `middle`: the segments
  /// where forces are taken [m].
  double flow_force(int before, int after, const VectorArray& middle) const;
  /// By what a unit of such a flow changes the loads on nodes. Returns by what it changes what drives it [N/m].
  double flow_column(int before, int after, const VectorArray& middle, FlowColumn& column) const;
  bool is_damped() const { return active_ && is_damped_; }
  /// At an inner node.
  BendDamping<double> damping_at(int node) const;
  double turned_square() const { return turned_square_; }  ///< see BendDamping
  /// That with which forces were found last, where others have found them.
  void set_share(double share) { share_ = share; }
  const std::vector<ClampJoint>& clamps() const { return clamps_; }
  /// Adds the forces of the segments on their first nodes [N], for displacements of the nodes [m].
  void add_segment_forces(const VectorArray& displacement, VectorArray& pull);
  /// Adds what `add_segment_forces` found last to the matrix.
  void add_stiffness(KktSystem& system) const;
  /// What damping does to the angular momentum [N m], which a cable as a whole would keep.
  Vector3 damping_torque(const VectorArray& displacement) const;
  /// What damping takes from the energy [J], clamps left out.
  double damping_work(const VectorArray& displacement) const;
  /// The same with clamps, which are bent so.
  double find_loss(const VectorArray& displacement);
  /// Adds what damping does where the material turns about the cable [N m] to the `torque` of clamps that turn it.
  void turn_clamps(const VectorArray& displacement, std::vector<HeldDirection>& directions) const;
  /// Adds the moments on the holders of directions [N m] to their `torque`.
  void react(const VectorArray& displacement, std::vector<HeldDirection>& directions);

 private:
  Vector3 change_at(int node, const VectorArray& displacement) const;
  BendDamping<Pair> damping_of_pair(int node) const;
  void find_share();
  void turn_with_material(const CableModel& model, const CableState& state, const VectorArray& segment,
                          const std::vector<HeldDirection>& directions, double h);
  void bend_clamps(const VectorArray& displacement);

  bool active_ = false;
  bool is_damped_ = false;
  int segments_ = 0;
  double part_ = 0.5;
  /// A segment whose rest length changes in the substep [m].
  struct GrowingSegment {
    int segment = 0;
    double start = 0, end = 0;
  };
  /// A joint beside one, whose stiffness [N m] changes.
  struct ChangingJoint {
    int node = 0;
    double start = 0, end = 0;
    double length = 0;  ///< [m] of the cable that it stands for, at the start
  };
  void grow(int segment, double growth);
  void set_changing(int node);
  void add_growth(const VectorArray& displacement);
  Vector3 growth_at(int node, const GrowingSegment& growing, const VectorArray& displacement) const;

  VectorArray segment_;               // at the start [m]; where there are flows
  std::vector<double> rest_lengths_;  // segments, at the start [m]; where there are flows
  std::vector<GrowingSegment> growing_;
  std::vector<ChangingJoint> changing_;
  std::vector<double> inverse_length_;       // segments [1/m]
  std::vector<double> stiffness_, damping_;  // nodes: EI / l and damping / (l h) [N m]; 0 at ends and clamps
  VectorArray start_;                        // nodes: e at the start
  std::vector<double> start_square_;         // nodes: |e|² at the start
  MaterialSpin spin_;
  VectorArray turn_;             // nodes: of e with the material, a radian
  VectorArray driven_, turned_;  // nodes: see BendDamping
  double turned_square_ = 0;
  double share_ = 0;             // see turned_share; of the iterate that was found last
  VectorArray change_, moment_;  // nodes: change of e; moment along it [N m]
  std::vector<double> slope_;    // nodes: of the moment over e, without damping [N m]
  std::vector<ClampJoint> clamps_;
};

/// [J], `directions` at their ends. `driven`: a segment whose rest length is driven, -1: none. As in a substep, it counts as long
/// as it is unstrained: growth is no bending. `shaped`: nodes on wheels, at which no moment resists.
double bending_energy(const CableModel& model, const CableState& state, const std::vector<HeldDirection>& directions,
                      const std::vector<int>& shaped, int driven = -1);

}  // namespace verlet_cable

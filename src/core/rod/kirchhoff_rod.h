#pragma once

#include <vector>

#include "rod/rod_elimination.h"
#include "rod/rod_joints.h"
#include "target/boundary.h"
#include "verlet_cable/core/cable.h"
#include "verlet_cable/core/ledger.h"

namespace verlet_cable {

/// Bending and twist of a cable that has a frame of its material on every segment, over a substep: Kirchhoff's rod, with two
/// bending stiffnesses, curvature and twist at rest, twist that varies along it, and the inertia of its section about the
/// tangent.
///
/// In a substep a frame turns by the Cayley rotation (1 + [w]x / 2 / ...) of
///   w = t x t' / |m|² + tau m,   m = (t + t') / 2,
/// with t and t' the segment's directions at start and end, which `tau` adds its twist to. Moments of joints (see RodJoints) turn
/// segments: what of them is normal to a segment acts as a pair of forces on its nodes, the rest is the equation for tau,
///   N . t = 0,   N = M_after - M_before - J (spin' t' - spin t) / h,   spin' = 2 tau |m|² / h - spin,
/// or spin' = tau |m|² / h where forces are taken at the end of the substep, which damps.
class KirchhoffRod {
 public:
  void resize(int segments);
  /// `segment` [m]: at the start; `part`: where in the substep forces are taken; `damping_time` [s]: infinite in statics, which
  /// begin without spin.
  void start(const CableModel& model, const CableState& state, const VectorArray& segment, const Boundary& boundary, double h,
             double damping_time, double part);
  /// For a cable that is none.
  void leave_out() { active_ = false; }
  bool active() const { return active_; }

  /// Takes over where the clamps are at the end of the substep, which bodies decide in its course.
  void follow_clamps(const Boundary& boundary);

  // Where material flows through guides; see Bending
  void forget_flows();
  void add_flow(int before, int after, double way);
  /// What of the energy drives such a flow [N], for the frames that `add_segment_forces` found last.
  double flow_force(int before, int after) const;

  /// Adds the forces of the segments on their first nodes [N]. `segment`: at the start, `middle`: where forces are taken [m].
  void add_segment_forces(const VectorArray& displacement, const VectorArray& segment, const VectorArray& middle,
                          VectorArray& segment_force);
  /// Sets the matrix for what `add_segment_forces` found last. `density`: tension over length [N/m].
  void assemble(const VectorArray& middle, const std::vector<double>& density);
  void factor(const KktSystem& system);
  void solve(const KktSystem& system) { elimination_.solve(system, stiffness_.torque); }
  /// Adds a part of the solution to the twist increments; the largest change [rad].
  double correct(double part);
  /// From here on only with the part of the tangent that is always positive, which leads further and converges more slowly.
  void simplify() { simplified_ = true; }

  /// Adds to the loads what clamps that turn by `rotation` [rad] (of the directions that the boundary holds) exert.
  void add_clamp_loads(const std::vector<Vector3>& rotations, KktSystem& system);
  /// Adds what the last solution changes of the torques on the clamps' holders [N m]; clamps turned as in `add_clamp_loads`, or
  /// not if `system` moves no holders.
  void add_clamp_reactions(const KktSystem& system, std::vector<Vector3>& torques) const;
  /// Adds the torques on the clamps' holders [N m] of the present iterate.
  void add_clamp_torques(std::vector<Vector3>& torques) const;

  /// Writes the moments on clamps [N m] and their joints' twist, and turns the frames for the last time.
  void finish(const VectorArray& displacement, const VectorArray& segment, Boundary& boundary);
  void store(const Boundary& boundary, CableState& state) const;
  /// Adds what damping takes in the substep, once it is finished.
  void add_losses(EnergyBalance& balance) const;
  /// Where motion was found that is not resolved, sections that alternate spin as they did on the mean over the substep: twist is
  /// the fastest motion of all. Returns the kinetic energy that is taken [J], which is not negative.
  double calm_spin(CableState& state) const;

  RodElimination& elimination() { return elimination_; }
  const RodElimination& elimination() const { return elimination_; }
  std::vector<double>& torque() { return stiffness_.torque; }  ///< segments: out of balance, about the tangent [N m]

 private:
  struct ClampJoint {
    int target = 0;                      ///< index of the held direction
    int segment = 0;                     ///< the segment next to the clamp
    bool after = true;                   ///< the segment comes after the clamp
    Vector3 rotation = Vector3::Zero();  ///< [rad] in the last solution for moved clamps
  };

  /// A joint beside a segment whose rest length changes in the substep.
  struct ChangingJoint {
    int node = 0;
    double start = 0, end = 0;   ///< [m] that it stands for
    JointStiffness stiffness;    ///< at the start
    double way = 0;              ///< [m] of the flow that changes it
    HalfBend backward, forward;  ///< [rad/m] what a way of material towards the cable's start, or its end, brings it
  };

  void start_segments(const CableModel& model, const CableState& state, const VectorArray& segment);
  void start_joints(const CableModel& model, const CableState& state, const Boundary& boundary, double damping_time);
  void start_clamps(const CableModel& model, const CableState& state, const std::vector<HeldDirection>& directions,
                    double damping_time);
  void turn_frames(const VectorArray& displacement, const VectorArray& segment);
  static void find_brought(const GuidedFlow& flow, const CableState& state, ChangingJoint& joint);
  static const HalfBend& brought_to(const ChangingJoint& joint) { return joint.way > 0 ? joint.forward : joint.backward; }
  static JointStiffness stiffness_at_end(const ChangingJoint& joint);
  double force_of_brought(const ChangingJoint& joint) const;
  void set_clamp_frames();
  void store_memory(CableState& state) const;
  Vector3 turned_by_clamp(const ClampJoint& clamp, int joint, const Vector3& rotation) const;
  void set_stiffness(const VectorArray& direction, bool simple);

  bool active_ = false;
  bool elastic_ = false;
  bool simplified_ = false;
  bool slides_ = false;  // what its joints remember changes as they are bent
  int segments_ = 0;
  bool is_static_ = false;
  double h_ = 0, part_ = 0.5;
  double spin_rate_ = 2;  ///< of (tau / h - spin) / h in the equation for tau
  // Segments
  std::vector<double> inertia_;  // about the tangent [kg m^2]
  std::vector<double> spin_;     // at the start [rad/s]
  std::vector<double> tau_;      // the unknowns: twist increments [rad]
  FrameMotion frames_;
  VectorArray net_moment_;  // of its joints [N m]
  RodJoints joints_;        // nodes: that between segments i - 1 and i
  std::vector<ChangingJoint> changing_;
  // Joints of clamps with segments
  std::vector<ClampJoint> clamps_;
  FrameMotion clamp_before_, clamp_after_;
  RodJoints clamp_joints_;
  RodStiffness stiffness_;
  RodElimination elimination_;
};

/// [J]
struct RodEnergy {
  double bend = 0, twist = 0;  ///< elastic
  double spin = 0;             ///< of the section about the tangent
};
/// Of a whole rod, whose clamps hold `directions` at their ends.
/// `shaped`: nodes on wheels, at which no bending moment resists.
RodEnergy rod_energy(const CableModel& model, const CableState& state, const std::vector<HeldDirection>& directions,
                     const std::vector<int>& shaped);

/// Lets a whole rod that was given its shape at once, and not by motion, yield as far as it does in that shape. Its clamps hold
/// `directions` at their ends. `shaped`: nodes between segments that do not yield to it.
void yield_to_shape(const CableModel& model, const std::vector<HeldDirection>& directions, const std::vector<int>& shaped,
                    CableState& state);

}  // namespace verlet_cable

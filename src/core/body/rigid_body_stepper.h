#pragma once

#include <vector>

#include "body/body_algebra.h"
#include "body/body_fluid_forces.h"
#include "body/body_progress.h"
#include "body/group_momenta.h"
#include "body/mass_properties.h"
#include "rod/substep.h"
#include "verlet_cable/core/body.h"
#include "verlet_cable/core/load.h"

namespace verlet_cable {

/// What a substep is done with, whatever it moves.
struct SubstepRules {
  double h = 0;          ///< [s]
  bool statics = false;  ///< a step towards equilibrium: inertia only slows it
  Scheme scheme = Scheme::conserving;
  double middle = 0;  ///< [s] the world's time in the middle of the substep

  double part() const { return statics || scheme != Scheme::conserving ? 1 : 0.5; }
  double inertia() const { return inertia_of(scheme); }
};

/// Advances one rigid body by one substep, together with the cables that it holds: stages for a solver that has both. The scheme
/// is that of the cables (see CableStepper); for the rotation, with the Cayley vector w from start to end, W = R^T omega and
/// Theta = R^T w,
///   R' J (2 Theta / h - W) - R J W = h torque,   W' = 2 Theta / h - W
/// which keeps angular momentum and energy (Simo and Wong 1991, with Cayley's rotation in place of the exponential). A force acts
/// with the mean of its arm at the start and the end: then its work is force . (displacement of its point).
///
/// Added mass couples the two (Kirchhoff's equations; Lamb, Hydrodynamics, 1932, chapter VI). With the velocity V = R^T v of the
/// center of mass against the water along the body's axes, the momenta R P and R L of (V, W) by one constant matrix, and the way
/// u through the water,
///   R' P' - R P = h force,   R' L' - R L + u x (R P + R' P') / 2 = h torque,   V' = 2 B^T u / h - V,   B = (1 + [w] / 2) R
/// keep energy and both momenta: u . (R' P' - R P) + w . (u x (R P + R' P') / 2) is u . B (P' - P).
class RigidBodyStepper {
 public:
  /// `whole`: the body with the nodes of cables that it holds, in the axes of its frame.
  void begin(const SimulatedBody& body, const BodyProgress& progress, const MassProperties& whole, const Environment& environment,
             const SubstepRules& rules);
  /// Lets a load act on it, after `begin`. It has to stay where it is.
  void apply(const Load& load) { applied_.push_back(&load); }

  // The present iterate
  Pose pose() const;                                ///< of the body's frame at the end
  Vector3 position_of(const Vector3& point) const;  ///< [m] at the end, of a point in the frame's axes
  Vector3 end_arm(const Vector3& point) const { return end_ * (point - whole_.center_of_mass); }
  /// With which a force on a point acts about the center of mass.
  Vector3 force_arm(const Vector3& point) const;
  const Eigen::Matrix3d& end() const { return end_; }
  const Vector3& start_center() const { return center_; }        ///< [m]
  const Vector3& displacement() const { return displacement_; }  ///< [m] of the center of mass
  Vector3 turn() const { return start_ * turn_; }                ///< the Cayley vector from start to end

  /// Forces and torques about the center of mass that are out of balance, without those of cables and holders [N], [N m].
  Vector6 load() const;
  /// The resistance against displacements of the center of mass and rotations.
  Matrix6 stiffness() const;
  void correct(const Vector6& change);

  /// [kg], [kg m], [kg m^2] Of velocities of the center of mass and spins at the end, in the fixed frame's axes.
  Matrix6 inertia() const;
  double added_mass() const {
    return added_mass_;
  }  ///< [kg] the largest of its axes; above 0, the fluid has a part of its momenta
  /// What its forces leave of its momenta, and what it has at the end.
  void expect_momenta(GroupMomenta& group) const;
  void add_momenta(GroupMomenta& group) const;

  /// [J] That its damping takes in the substep.
  double damping_work() const;
  /// [J] Of what is applied to it, in the substep.
  double applied_work() const;
  /// Adds what the fluid does in the substep.
  void add_fluid_work(EnergyBalance& balance) const;

  /// Velocities at the end.
  void finish(SimulatedBody& body, BodyProgress& progress) const;
  Vector3 velocity_of(const Vector3& point) const;    ///< [m/s] at the end
  Vector3 spin() const { return end_ * end_spin(); }  ///< [rad/s] at the end

 private:
  double damping_rate() const { return rules_.statics ? 0 : 1 / rules_.h; }
  /// A force [N] and a torque [N m] about the center of mass.
  struct Wrench {
    Vector3 force, torque;
  };
  Wrench wrench_of(const Load& load) const;
  Matrix6 stiffness_of(const Load& load) const;
  Vector3 weight() const;
  BodyWay way() const { return {start_, end_, displacement_, turn()}; }
  void add_mass(const BodyFluidDesc& fluid);
  Vector3 way_in_water() const { return displacement_ - rules_.h * fluid_.flow(); }
  Vector6 mean_rate() const;
  Vector6 added_end_momentum() const;
  Vector6 momentum_rate() const;
  Matrix6 momentum_stiffness() const;
  Vector3 end_momentum() const;
  Vector3 end_velocity() const;
  Vector3 end_spin() const;
  void turn_by(const Quaternion& turn);

  SubstepRules rules_;
  MassProperties whole_;
  double mass_ = 0;                // of the body alone [kg]
  Vector3 own_ = Vector3::Zero();  // its center of mass, from that of the whole
  double linear_damping_ = 0, angular_damping_ = 0;
  const GravityDesc* gravity_ = nullptr;
  BodyFluidForces fluid_;
  // Of the whole with its added mass, along the frame's axes: what of V and W makes P and L
  double added_mass_ = 0;
  Matrix6 inertia_;
  Vector6 rate_, rate_change_;  // V and W at the start [m/s], [rad/s], and how they change [m/s^2], [rad/s^2]
  std::vector<const Load*> applied_;
  // At the start
  Vector3 center_, velocity_, acceleration_;  // of the whole
  Quaternion orientation_ = Quaternion::Identity();
  Eigen::Matrix3d start_;
  Vector3 spin_, spin_change_;  // [rad/s], [rad/s^2] in the frame's axes
  // The unknowns
  Vector3 displacement_;  // of the center of mass [m]
  Quaternion end_orientation_ = Quaternion::Identity();
  // Which follow from them
  Eigen::Matrix3d end_;
  Vector3 turn_;  // Theta
};

}  // namespace verlet_cable

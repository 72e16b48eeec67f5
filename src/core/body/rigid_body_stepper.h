#pragma once

#include <Eigen/Core>
#include <vector>

#include "body/body_progress.h"
#include "body/group_momenta.h"
#include "body/mass_properties.h"
#include "rod/substep.h"
#include "verlet_cable/core/body.h"
#include "verlet_cable/core/load.h"

namespace verlet_cable {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// What a substep is done with, whatever it moves.
struct SubstepRules {
  double h = 0;          ///< [s]
  bool statics = false;  ///< a step towards equilibrium: inertia only slows it
  Scheme scheme = Scheme::conserving;

  double part() const { return statics || scheme != Scheme::conserving ? 1 : 0.5; }
  double inertia() const { return inertia_of(scheme); }
};

/// The skew matrix of a cross product with v on the left.
Eigen::Matrix3d cross_matrix(const Vector3& v);
/// By what the torque of a force that stays as it is changes as its arm turns.
Eigen::Matrix3d turned_torque(const Vector3& arm, const Vector3& force);

/// Advances one rigid body by one substep, together with the cables that it holds: stages for a solver that has both. The scheme
/// is that of the cables (see CableStepper); for the rotation, with the Cayley vector w from start to end, W = R^T omega and
/// Theta = R^T w,
///   R' J (2 Theta / h - W) - R J W = h torque,   W' = 2 Theta / h - W
/// which keeps angular momentum and energy (Simo and Wong 1991, with Cayley's rotation in place of the exponential). A force acts
/// with the mean of its arm at the start and the end: then its work is force . (displacement of its point).
class RigidBodyStepper {
 public:
  /// `whole`: the body with the nodes of cables that it holds, in the axes of its frame.
  void begin(const SimulatedBody& body, const BodyProgress& progress, const MassProperties& whole, const GravityDesc& gravity,
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

  /// What its forces leave of its momenta, and what it has at the end.
  void expect_momenta(GroupMomenta& group) const;
  void add_momenta(GroupMomenta& group) const;

  /// [J] That its damping takes in the substep.
  double damping_work() const;
  /// [J] Of what is applied to it, in the substep.
  double applied_work() const;

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

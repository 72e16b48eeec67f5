#pragma once

#include "body/body_algebra.h"
#include "rod/substep.h"
#include "verlet_cable/core/body.h"
#include "verlet_cable/core/ledger.h"

namespace verlet_cable {

/// How a body goes over a substep, its rotation matrices R at the start and R' at the end.
struct BodyWay {
  Eigen::Matrix3d start, end;
  Vector3 displacement;  ///< [m] of what it turns about
  Vector3 turn;          ///< the Cayley vector from start to end
};

/// What the fluid does to a body in a substep, besides the inertia of its added mass: at the center C of its fluid, with the
/// water as it is where C gets by itself in the middle of the substep, immersed by the part k of a sphere that is below the
/// surface,
///   k density volume (a - g) + k density / 2 R (area |v| v) + R (added mass) R^T a,   torque -k (angular drag) |W| W
/// with the water's acceleration a, its velocity v against C and the body's spin W along the body's axes. The part k is the mean
/// over the way from start to end, so that buoyancy in still water has a potential. In statics the water has no waves, and of the
/// inertia of added mass the torque -U x R (added mass) R^T U of a current U is left (Munk 1924).
class BodyFluidForces {
 public:
  /// `center`, `velocity`: of C at the start [m], [m/s]; `arm`: to it from what the body turns about, in the body's axes [m].
  void begin(const BodyFluidDesc& body, const Environment& environment, double middle, double h, bool statics,
             const Vector3& center, const Vector3& velocity, const Vector3& arm);
  bool active() const { return active_; }
  /// [m/s] Of the water that its added mass moves against; none where it is out of the water.
  const Vector3& flow() const { return flow_; }

  /// Forces and torques about what the body turns about [N], [N m]. `part`: where in the substep forces are taken.
  Vector6 load(double part, const BodyWay& way) const;
  /// By what they resist displacements and rotations.
  Matrix6 stiffness(double part, const BodyWay& way) const;
  /// Adds the work of the loads: what is lost against the water, and what the water adds.
  void add_work(double part, const BodyWay& way, EnergyBalance& balance) const;

 private:
  /// Of an iterate.
  struct Forces {
    Eigen::Matrix3d axes;  // of the body, where forces are taken
    Vector3 displacement;  // of C [m]
    Vector3 against;       // [m/s] the water's velocity against C, along the body's axes
    Vector3 spin;          // [rad/s] along the body's axes
    double immersed;       // [m^3], or 0 to 1 of what has no volume
    double immersion;      // [m^2] by which that grows with depth
    Vector3 drag, torque;  // [N], [N m] of what is all below the surface
    Vector3 pressure;      // [N] of that, by the water's acceleration and weight
    Vector3 carried;       // [N] of added mass
    Vector3 static_torque;
    double part;  // of it that is below the surface
    Vector3 force() const { return part * (drag + pressure) + carried; }
  };
  Forces forces(double part, const BodyWay& way) const;
  double volume_below(double depth) const;
  double area_at(double depth) const;
  Eigen::Matrix3d added_mass(const Eigen::Matrix3d& axes) const;

  bool active_ = false, statics_ = false;
  BodyFluidDesc body_;
  double density_ = 0, h_ = 0, rate_ = 0;  // [kg/m^3], [s], [1/s] of displacement to velocity, 0 in statics
  double radius_ = 0, depth_ = 0;          // [m] of the sphere; of C below the surface at the start
  bool is_wet_ = false;                    // in the middle of the substep
  Vector3 arm_, gravity_, flow_ = Vector3::Zero();
  WaterMotion water_;
};

}  // namespace verlet_cable

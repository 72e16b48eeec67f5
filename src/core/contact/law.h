#pragma once

#include <array>
#include <cstdint>

#include "chain/cable_point.h"
#include "contact/moving_obstacle.h"
#include "rod/scheme.h"
#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// A cable that rolls on what it touches where friction across it would be more than a part of all that there can be.
struct Rolling {
  Vector3 across = Vector3::Zero();  ///< the cable, along the surface
  double part = 1;
};

/// How a contact resists: with w the displacement over the substep of what touches relative to what is touched, e = rate * w -
/// offset is the displacement that is expected at the end of the substep and a little later (see `anticipate`), and
///   normal force     f = max(0, force of the depth -gap - n . e)
/// (of soft sections: their stiffness times the depth as far as they are soft, and beyond that the stiff law's besides)
///   friction        -k (bristle + tangential part of e), at most friction * f, and across a cable that rolls a part of that
/// What bounds friction is f itself or, where that is held, an f of before: then friction has a potential, whose minimum Newton's
/// method finds.
/// The bristle is the tangential displacement since the contact began to stick (Cundall and Strack, A discrete numerical model
/// for granular assemblies, 1979): a contact that sticks does not creep. It belongs to the material that is touched and turns
/// with it.
struct Touch {
  std::uint64_t key = 0, other_key = 0;  ///< what touches what; ascending in a list of touches
  CablePoint point, other;
  int obstacle = -1;
  int body = -1;                        ///< what touches the obstacle, or is touched; index into World::bodies()
  Vector3 position = Vector3::Zero();   ///< [m] of the point
  Vector3 normal = Vector3::UnitZ();    ///< out of what is touched
  bool inside = false;                  ///< it was deep inside from the start: it is pushed out gently
  double inside_depth = 0;              ///< [m] of the deepest place of a shape that is inside
  double inside_for = 0;                ///< [s] it has been inside
  bool yields = false;                  ///< likewise two cables: with no more than stops them within a step
  double gap = 0;                       ///< [m] between the surfaces at the start of the substep
  double friction = 0;                  ///< Coulomb coefficient
  Vector3 lean = Vector3::Zero();       ///< along the surface: friction is bounded around a force times this
  std::array<Rolling, 2> rolling;       ///< of the cables that may roll,
  int rolling_count = 0;                ///< so many
  double radius = 0;                    ///< [m] of the thinner cable
  double share = 1;                     ///< of the force that the law has at its depth: it bears with others
  double base_stiffness = 0;            ///< [N/m] at no depth, of a share of 1
  double length = 0, other_length = 0;  ///< [m] of the cables that it presses on; 0 where no material asks for it
  double soft_stiffness = infinity;     ///< [N/m] of the sections that it squeezes; infinite: of the law alone
  double soft_depth = 0;                ///< [m] as far as they are soft
  double rate = 1;
  Vector3 offset = Vector3::Zero();               ///< [m]
  Vector3 stuck_force = Vector3::Zero();          ///< [N] friction at the start of the substep, as it is turned in the middle
  double last_force = 0;                          ///< [N] normal force in the substep before
  bool bound_is_held = false;                     ///< what bounds friction stays as it is
  Vector3 velocity = Vector3::Zero();             ///< [m/s] of the point at the start, relative to another cable that is touched
  Vector3 body_acceleration = Vector3::Zero();    ///< [m/s^2] of a body's point, at the start
  Vector3 start_arm = Vector3::Zero();            ///< [m] to it from the center of mass of the body with what it holds
  SurfaceMotion other_motion;                     ///< of an obstacle that is touched
  Quaternion half_turn = Quaternion::Identity();  ///< likewise: MovingObstacle's
  // Of the present iterate
  Vector3 displacement = Vector3::Zero();                      ///< [m] w
  double depth = 0;                                            ///< [m] where the force's law is linearised
  double depth_force = 0;                                      ///< [N] there
  double stiffness = 0;                                        ///< [N/m] there
  double normal_stiffness = 0;                                 ///< [N/m] of the normal force, in the equations
  double normal_force = 0;                                     ///< [N]
  double bound = 0;                                            ///< [N] the normal force that bounds friction
  Vector3 force = Vector3::Zero();                             ///< [N] on the point
  Vector3 arm = Vector3::Zero();                               ///< [m] with which the force acts on a body,
  Vector3 turning = Vector3::Zero();                           ///< [m] and what its part along the cable does beside that
  Vector3 correction = Vector3::Zero();                        ///< [m] of w, after the force was found for the last time
  Vector3 followed = Vector3::Zero();                          ///< [N] friction that follows the correction's normal force
  double part = 1;                                             ///< of the friction that sticking would take
  double rolling_part = 1;                                     ///< the same across the cable that rolls
  Vector3 across = Vector3::Zero();                            ///< which is this direction
  enum class Mode { open, sticks, slides } mode = Mode::open;  ///< at first that of the substep before
};

/// Makes a touch that of sections whose stiffness in series is this [N/m]: a section's share of the compression between two sides
/// is half, so that for each side it has twice the `transverse_stiffness` times the length that is pressed. Before `start_touch`.
void soften(double stiffness, Touch& touch);

/// [N/m] Of a contact without load, with a mass [kg] that it stops within about a step [s].
double stopping_stiffness(double mass, double time_step);

/// How long contacts take to come to rest [s], for a world's time step [s].
double contact_time(double time_step);

/// Sets `rate` and `offset` for a substep of length h [s]: a contact acts on where it will be a contact time after the end of
/// the substep if it moves on with the velocity that it then has by the scheme. `acceleration` [m/s^2]: as Touch::velocity.
void anticipate(Scheme scheme, double h, double contact_time, const Vector3& acceleration, Touch& touch);

/// The gap [m] of what is pushed out at a gentle velocity: nothing deeper is taken for deeper where a cable starts inside.
double gentle_gap(double radius, double contact_time);

/// [N] That a touch with a share of 1 has at a depth [m], none outside.
double force_of_depth(double depth, const Touch& touch);

/// Linearises the law at the start of the substep.
void start_touch(Touch& touch);

/// Sets the force for a displacement w [m]. True if the contact has changed its mode or its linearisation.
bool evaluate_touch(const Vector3& w, Touch& touch);

/// Takes over where a touch has come to after the last correction.
inline void follow_correction(const Vector3& w, Touch& touch) {
  touch.correction = w - touch.displacement;
  touch.displacement = w;
}

/// Whether it presses on something that is inside.
inline bool is_pushed_out(const Touch& touch) {
  return touch.inside && touch.mode != Touch::Mode::open;
}

/// From now on friction is bounded by this normal force [N].
inline void hold_bound(double normal_force, Touch& touch) {
  touch.bound = normal_force;
  touch.bound_is_held = true;
}

/// [N] The force that the equations of what touches have, after the last correction.
Vector3 corrected_force(const Touch& touch);

/// [N/m] - d force / d w of a touch that is not open, without the part of friction that follows f. Where that has a part, it is
/// the secant along the slip, not the tangent, which is nothing: iterations would turn it to and fro.
Eigen::Matrix3d slope(const Touch& touch);

/// The same with the part of friction that follows f.
Eigen::Matrix3d full_slope(const Touch& touch);

/// Over f, the friction that follows it: all of what slides, and what sticks leans by.
Vector3 following_friction(const Touch& touch);

/// A force [N] as the obstacle that is touched turns it in half the substep.
inline Vector3 half_turned(const Touch& touch, const Vector3& force) {
  return touch.half_turn.w() == 1 ? force : Vector3(touch.half_turn * force);
}

/// Friction [N] that stays when the substep is done: the bristle's without what velocity adds. Of what sticks it may be beyond
/// the cone: cut off, it would follow what still comes to rest, and that would go on for ever.
Vector3 remaining_friction(const Touch& touch);

}  // namespace verlet_cable

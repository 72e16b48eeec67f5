#pragma once

#include <algorithm>
#include <vector>

#include "geometry/vector_array.h"
#include "rod/block_elimination.h"
#include "rod/scheme.h"
#include "target/boundary.h"
#include "verlet_cable/core/cable.h"

namespace verlet_cable {

/// What is done about motion that substeps do not resolve, once it is found: nothing; it is taken out of the velocities; or the
/// next substeps damp it, where it keeps substeps short or contacts busy.
enum class Treatment { none, cleaning, damping };

/// Substeps that damp after motion was found that they do not resolve: as `next_scheme` says.
constexpr int damped_substeps = 3;

/// How the next substep of a cable goes.
Scheme next_scheme(const CableModel& model, const CableState& state);

/// Motion begins anew, as after an edit: the next two substeps are not judged.
void begin_anew(UnresolvedMotion& motion);

/// How much of what `known` says counts as a change of the change of acceleration: changes from or to what was before the motion
/// began anew are none.
inline double known_part(const UnresolvedMotion& motion) {
  return motion.known < 2 ? 0 : 0.5;
}

/// Sums over a cable's nodes that move.
struct MotionSums {
  double product = 0;  ///< [N^2/kg] mass times a turn (or change, where what is found is to be damped) times the one before
  double square = 0;   ///< [N^2/kg] mass times the mean of their squares
  double mass = 0;     ///< [kg]
};

/// After a substep: adds what it has changed to what is known of the motion. True if motion was found that is not resolved; what
/// is known is then forgotten.
bool is_unresolved(Treatment treatment, const MotionSums& sums, UnresolvedMotion& motion);

/// How much of a change of velocities makes no energy, 0 to 1, where what is known to be lost beside it is `known` [J], not
/// negative, and a share of the change loses known + share * along - share^2 * square [J].
double losing_share(double known, double along, double square);

/// The same of impulses that end rates of lengths at the end of a substep of `h` [s]. They take half of `ended` [J], which is the
/// impulses times the rates, but holders give them what they do over their ways in the substep, not at the velocities of its end.
/// `impulse_on(node)` [N s]: on a held one.
template <class ImpulseOn>
double losing_share_of_projection(const std::vector<HeldNode>& held, double h, double ended, const ImpulseOn& impulse_on) {
  double along = ended, known = 0;
  for (const HeldNode& node : held) {
    along += impulse_on(node.node).dot(node.velocity - node.displacement / h);
    known -= node.unresolved;
  }
  return losing_share(std::max(0.0, known), along, 0.5 * ended);
}

/// Finds motion of a cable that substeps do not resolve, and takes it out of the velocities. Where it is resolved, with phase p a
/// substep (p = 2 atan(omega h / 2) for a frequency omega), successive turns of the accelerations (differences of their changes)
/// have products that are cos(p) of their squares; what is much faster turns round from each substep to the next, for ever: -1.
/// Of slow motion with fast motion on it, turns show the fast one. Where substeps will damp what is found, it is the changes
/// themselves that are looked at.
class MotionCleaner {
 public:
  void resize(int nodes);

  /// After a substep: adds what it has changed to what is known of the cable's motion. True if motion was found that is
  /// not resolved; what is known is then forgotten. `movable`: a node, 1 or 0; `before`: a node, accelerations at the substep's
  /// start [m/s^2].
  bool finds_unresolved(Treatment treatment, const std::vector<double>& movable, const VectorArray& before, CableState& state);

  /// Sets the right-hand side of
  ///   (A + K) y = A (v_3 - 3 v_2 + 3 v_1 - v_0) / 8,
  /// of the last four velocities, with A the inertia (`inertia`, a node [kg/s^2]) and A + K the matrix of the system. The part
  /// that alternates is then w = (...) / 8 - y: of motion of frequency omega it is s^5 e^(3/2 i (pi - p)) where s = sin(p / 2):
  /// all of it where omega h is large, O((omega h)^5) where it is resolved. Without w the velocities `end_velocity` [m/s] change
  /// the lengths of inextensible `segment`s [m] by `growth` [m^2/s] alone, half of their squares'. The last substep took h [s].
  void load(double h, const CableModel& model, const CableState& state, const std::vector<double>& inertia,
            const VectorArray& segment, const VectorArray& end_velocity, const std::vector<double>& growth, KktSystem& system);

  /// Takes w out of the velocities, or as much of it as makes no energy: it would where p is less than 2/3 pi. Free cables keep
  /// their momenta. `work` [J]: of holders and winches, for all of w; `solution`: y; `place` [m]. Returns how much, 0 to 1.
  double take_out(double h, double work, const std::vector<HeldNode>& held, const VectorArray& solution, const VectorArray& place,
                  CableState& state);

 private:
  void keep_momenta(const std::vector<double>& masses, const VectorArray& place);

  VectorArray alternating_;  // nodes: third difference of the velocities, then w [m/s]
};

}  // namespace verlet_cable

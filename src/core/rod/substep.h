#pragma once

#include <cmath>
#include <vector>

#include "fluid/waves.h"
#include "rod/scheme.h"
#include "rod/twist.h"
#include "rod/unresolved_motion.h"
#include "target/boundary.h"
#include "verlet_cable/core/cable.h"
#include "verlet_cable/core/ledger.h"

namespace verlet_cable {

/// What acts on cables and bodies from outside, the same in all substeps of a step.
struct Environment {
  const GravityDesc& gravity;
  const FluidDesc& fluid;
  const std::vector<Wave>& waves;

  /// `time` [s]: the world's.
  WaterMotion water_at(const Vector3& point, double time) const { return verlet_cable::water_at(fluid, waves, point, time); }
};
/// Waves of still water.
inline const std::vector<Wave> no_waves;

/// A tolerated error is one of velocity in substeps up to this long [s]; beyond, the error of the place counts.
constexpr double longest_tolerated = 1e-3;
/// Of the kinetic energy and what lifts all by a segment, more that is missing in a step is told.
constexpr double accountable_part = 1e-4;
/// So much less an iterate may lack that ends its substep.
constexpr double untold_part = 0.5;
/// Corrections that shrink by less an iteration are rounding.
constexpr double rounding_ratio = 0.5;
/// A larger correction, in segment lengths, leads to solutions that have nothing to do with the motion: halve the step.
constexpr double largest_correction = 2;

/// No substep is shorter [s]; a cable that needs one has lost its way.
constexpr double shortest_substep = 1e-6;

/// What a substep is done with.
struct Substep {
  const CableModel& model;
  const Environment& environment;
  Boundary& boundary;             ///< forces and torques on the holders are written to it
  std::vector<TwistSpan>& spans;  ///< their twist is kept up
  double h;                       ///< [s]
  bool statics = false;           ///< a step towards equilibrium: inertia only slows it, nothing moves or is damped
  Scheme scheme = Scheme::conserving;
  Treatment treatment = Treatment::none;  ///< of motion that is found not to be resolved
  bool touches_bodies = false;            ///< whether contacts with bodies are looked at
  double tolerance = 1e-5;                ///< [1/s] of velocities, as SceneDesc's
  /// What bodies pull straight strains, too, by as little as what is straight between frames: bodies in line between two frames
  /// have no other solution.
  bool strains_on_bodies = false;
  /// What bodies draw out further than it is long gives in, as what can stretch does.
  bool gives_in_on_bodies = false;
  double middle = 0;  ///< [s] the world's time in the middle of the substep

  /// Where in the substep forces are taken.
  double part() const { return statics || scheme != Scheme::conserving ? 1 : 0.5; }
  /// [mass] Of (u / h - v) / h in the equations of motion, u being the displacement.
  double inertia() const { return inertia_of(scheme); }
  DrawnOut drawn_out() const;
  double damping_time() const { return statics ? infinity : h; }
};

struct SubstepResult {
  bool converged = false;
  int overstretched_node = -1;  ///< first node of a span that was lengthened; -1: none
  int iterations = 0;
  double max_strain = 0;    ///< largest |l / l0 - 1| at the end
  double displacement = 0;  ///< largest of a node [m]; in statics only
  EnergyBalance balance;    ///< but for the work of holders, contacts and guides that move; not of statics
};

/// The larger of two sizes; no number if either is none.
inline double larger(double a, double b) {
  return b <= a || std::isnan(a) ? a : b;
}

/// When the corrections of a substep's iterations are small enough.
class Convergence {
 public:
  explicit Convergence(const Substep& substep);
  /// `tolerance` [1/s], of substeps of `h` [s].
  Convergence(double tolerance, double h, bool statics);
  /// `size` [segment lengths or rad] of the last one.
  bool is_reached(double size);
  /// By which it was smaller than the one before; 1 of the first.
  double ratio() const { return ratio_; }
  /// About which part of what the last iterate lacked the next one does.
  double left() const;
  /// Whether so much energy is missing in the account of the last iterate that after its correction it would be told. `missing`,
  /// `told` [J]: see CableStepper. What only rounding corrects lacks none.
  bool lacks(double missing, double told) const { return ratio_ < rounding_ratio && left() * missing > untold_part * told; }

 private:
  double tolerance_;  // of the next correction, in segment lengths
  double last_ = 0, ratio_ = 1;
};

/// [N] Between two holders a rigid chain that is pulled straight has no unique tension, and one that is pushed together has no
/// motion. So much axial stiffness, relative to the weight of the cable, or of all that is joined to it by bodies, gives it both:
/// that weight strains it by a part in ten million.
double stiffness_of_taut(const Substep& substep, const CableState& state);

/// Nothing moves in statics.
YieldingAhead yielding_ahead(const Substep& substep, const CableState& state);

/// Whether holders on frames draw any span of the cable beyond its length, or will at once.
bool is_overstretched(const Substep& substep, const CableState& state);

/// [1/N] Of a span that is drawn beyond its length: it pulls like a spring of 1e4 times the weight of all that hangs together,
/// per unit of strain.
double compliance_of(const OverstretchedSpan& span, const Substep& substep, const CableState& state);

/// Whether bodies hold an inextensible part of the cable that is longer than it should be at the start of the substep, `state`.
bool is_drawn_out_on_bodies(const Substep& substep, const CableState& state);

/// [N] The same of a cable that bodies draw out beyond its length: as much as a soft rope's.
double stiffness_of_overstretched(const Substep& substep, const CableState& state);

/// [N] More has only what bodies draw out beyond its length: all that they join weighs a thousandth of it, or would be stopped by
/// it from any velocity within the substep, or it was a tenth of it before it was drawn out.
double greatest_tension_on_bodies(const Substep& substep, const CableState& state);

/// Whether bodies hold a part of the cable, of what cannot stretch, as good as straight. `state` is that at the start of the
/// substep.
bool is_straight_on_bodies(const Substep& substep, const CableState& state);

/// Whether the velocity of a holder that is no body changes: only then do velocities along the segments appear that the equations
/// do not damp. `state` is that at the start of the substep.
bool holders_accelerate(const Substep& substep, const CableState& state);

}  // namespace verlet_cable

#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "guide/flow.h"
#include "law/flow_rate.h"
#include "law/guide.h"
#include "law/stretch.h"
#include "rod/bending.h"
#include "rod/block_elimination.h"
#include "rod/fluid_forces.h"
#include "rod/kirchhoff_rod.h"
#include "rod/substep.h"
#include "rod/twist.h"

namespace verlet_cable {

/// Takes a cable's motion away.
void bring_to_rest(CableState& state);

/// Advances one cable by one substep. Holds the buffers, all sized by `resize`; keeps nothing from one call to the next.
///
/// The scheme is Verlet's with the stiff forces averaged over the step (Simo and Tarnow 1992; Gonzalez 1996):
///   x' = x + h (v + v') / 2,   m (v' - v) / h = gravity - drag (x' - x) / h + sum of T (d + d') / (s + s')
/// with d a segment's vector and s its length, at the start and (') the end. For an inextensible segment T is the multiplier of
/// s' = l; for an elastic one it is EA ((s + s') / (2 l) - 1) + axial damping. Both conserve momentum and energy exactly.
/// What substeps do not resolve would alternate in it for ever: see Scheme and MotionCleaner.
class CableStepper {
 public:
  void resize(int segments);  ///< does nothing where their number stays

  /// If it has not converged, `state` is untouched.
  SubstepResult advance(const Substep& substep, CableState& state);

  /// Takes motion that a conserving substep has not resolved out of the velocities of a cable that others have advanced.
  /// `start_multiplier`: CableState::axial_multiplier at the substep's start.
  void clean(const Substep& substep, const std::vector<double>& start_multiplier, CableState& state);

  // The stages of `advance`, for a solver of several cables at once: begin; evaluate, assemble, factor, solve and correct until
  // that has converged; finish.
  void begin(const Substep& substep, const CableState& state, SubstepResult& result);
  void evaluate(const Substep& substep, const CableState& state);
  /// Whether the matrix of the iterate before does not do for that which has been evaluated last.
  bool calls_for_matrix() const { return winch_.segment >= 0 && winch_.changed; }
  void assemble(double part);
  void factor();
  void solve_linear();  ///< for the loads that `evaluate` found; material flows through guides as it is driven
  double correct();
  /// Whether the guides' frictions act as the flows that were found last call for, and a winch as its tension does.
  bool flows_are_consistent(const Substep& substep) const;
  void take_back(double part);  ///< of the last correction
  /// `struck`: forces from outside have changed velocities abruptly.
  void finish(const Substep& substep, bool struck, CableState& state, SubstepResult& result);
  // For holders that move as the cable lets them, between `factor` and `correct`: rod/cable_holders.cpp
  /// Takes over where the holders are at the end of the substep.
  void follow_holders(const Boundary& boundary);
  /// What the cable exerts on its holders in the present iterate, without the inertia of the nodes that they hold; `corrected`:
  /// after the last solution, to first order.
  void read_holder_loads(const Substep& substep, const std::vector<double>& masses, bool corrected, HolderLoads& loads) const;
  /// Adds to the solution, which had the holders stay where they are, what it is that they move.
  void add_moved(const Boundary& boundary, const HolderMotion& motion);
  /// What the cable exerts on its holders where they move so and nothing else loads it; the solution stays as it is.
  void respond(const Boundary& boundary, const HolderMotion& motion, HolderLoads& loads);
  // Of velocities, once the substep is finished: begin; solve; read; respond; add moved; finish. See rod/cable_velocities.cpp
  /// The linear system is that of impulses which end all change of length of inextensible segments but that of rest lengths.
  void begin_projection(const Substep& substep, const CableState& state);
  /// On the holders [N s], after the last solution.
  void read_impulses(const Boundary& boundary, HolderLoads& impulses) const;
  /// The state's velocities take the solution.
  void finish_projection(const Substep& substep, CableState& state, SubstepResult& result);
  /// Whether the present iterate has the lengths that it should between holders. Where all nodes are held it may not, though no
  /// correction moves them any more.
  bool keeps_lengths() const;
  /// [N] Of the present iterate, of what cannot stretch between two holders.
  double greatest_tension_of_taut() const;
  /// [J] What tensions of the present iterate would do if they were what its lengths call for, less what they do; and what those
  /// of segments do that are not as long as they should be. `part`: where in the substep forces are taken, 1/2 or 1.
  double missing_work_of_tension(double part) const;
  /// [J] At the start of a substep: more is told if it is missing in a step, see `accountable_part`; infinite in statics.
  double told_energy(const Substep& substep, const CableState& state) const;
  double tension(int segment) const { return tension_density_[segment] * length_[segment]; }  ///< [N] of the present iterate
  const VectorArray& displacement() const { return displacement_; }  ///< nodes: x' - x of the present iterate [m]
  KktSystem& system() { return system_; }
  // The solution of the linear system: of nodes [m], of segments [N/m], and of a whole rod's segments [rad]
  const VectorArray& correction() const;
  const std::vector<double>& multiplier_correction() const;
  const std::vector<double>& twist_correction() const { return rod_.elimination().twist(); }
  /// Replaces it; not that of a whole rod.
  void set_correction(const VectorArray& displacement, const std::vector<double>& multiplier);
  /// Of a whole rod, what is out of balance about the segments' directions [N m]
  std::vector<double>& torque() { return rod_.torque(); }
  bool is_whole_rod() const { return rod_.active(); }

 private:
  bool is_elastic_at(int segment) const { return any_elastic_ && (!any_rigid_ || axial_stiffness_[segment] < infinity); }

  using Component = std::vector<double> VectorArray::*;

  void load(const Substep& substep, const CableState& state);
  void hold(const std::vector<HeldNode>& held);
  void set_loads(const Substep& substep, const CableState& state);
  void set_growth(const Substep& substep);
  void start_bending(const Substep& substep, const CableState& state);
  template <class Operation>
  void with_material(const Operation& operation);
  void predict(double h);
  bool solve(const Substep& substep, const CableState& state, SubstepResult& result);
  void evaluate_segments(double part, Component component);
  void evaluate_nodes(Component component);
  void evaluate_rigid_lengths();
  void evaluate_rigid_length(int segment);
  void evaluate_elastic_lengths(const Substep& substep, const std::vector<double>& rest_lengths);
  void evaluate_elastic_length(const Substep& substep, int segment, double rest_length);
  void set_row(int segment, const LengthRow<double>& row);
  /// How a segment's material is strained over the substep.
  struct Straining {
    double start = 0, end = 0;  ///< [m] rest lengths
    double growth = 0;          ///< [m] of the length, beyond what the growth of the rest length makes of it
  };
  Straining straining(const Substep& substep, int segment) const;
  void assemble_segments(double part, const std::vector<double>& density, const VectorArray& direction);
  void react(const Substep& substep, const std::vector<double>& masses);
  void exchange_loads();
  void solve_for_motion(const Boundary& boundary, const HolderMotion& motion);
  KktSolution& solution() { return rod_.active() ? rod_.elimination().solution() : solver_.solution(); }
  // Flows through guides: guide/flow_equations.cpp, flow_solution.cpp, flow_rates.cpp, flow_ends.cpp
  void start_flows(const Substep& substep, const CableState& state);
  void predict_flows(const Substep& substep);
  void set_flow_lengths(const Substep& substep);
  void evaluate_flows(const Substep& substep);
  bool lies_on_wheel(int segment) const;
  DrawnLength evaluate_flowing_length(const Substep& substep, int segment);
  Flow::Mode mode_of_way(const Substep& substep, const Flow& flow) const;
  Flow::Mode next_mode(const Substep& substep, const Flow& flow, const GuidedFlow& guided, double drive, double rubs) const;
  double resting_way(const Substep& substep, const Flow& flow) const;
  std::pair<double, double> stopped_ways(const Substep& substep, const Flow& flow) const;
  double stopped_way(const Substep& substep, const Flow& flow) const;
  bool comes_to_rest(const Substep& substep, const Flow& flow) const;
  double end_rate(const Substep& substep, const Flow& flow) const;
  void factor_flows();
  void let_flow();
  void add_column(const Flow& flow, double way);
  double along_row(const Flow& flow) const;
  double along(const Flow& flow, const FlowColumn& column) const;
  bool correct_flows(double part);
  bool grows(int segment) const;
  Vector3 flow_reaction(const Substep& substep, int node) const;
  void begin_flow_projection(const Substep& substep, const CableState& state);
  void finish_flows(const Substep& substep, CableState& state);
  void carry_frames_with_flows(const CableModel& model, CableState& state) const;
  FlowRate rate_of(const Substep& substep, const Flow& flow) const;
  void project_flows(const Substep& substep);
  void push_flows(const Substep& substep, SubstepResult& result);
  static void mend_flow(const Flow& flow, double change, GuidedFlow& guided, SubstepResult& result);
  // A winch that gives way: rod/winch_law.cpp
  void start_winch(const GrowingSegment& growing);
  void evaluate_winch(const Substep& substep);
  WoundLength wound_length(const Substep& substep) const;
  Resistance<double> strain_resistance(const Substep& substep, int segment) const;
  double wanted_by_winch(const Substep& substep, double end) const;
  double kept_tension_error(const Substep& substep, double end, double wanted) const;
  double winch_resistance() const;
  double least_winch_stiffness() const;
  bool winch_is_consistent(const Substep& substep) const;
  void wind_beyond(const Substep& substep, double wanted);
  double strain_energy(int segment, double rest, double length) const;
  double work_of_winch_beyond() const;
  double work_of_winding_at_once(const Substep& substep, const GrowingSegment& growing) const;
  void finish_winch(const Substep& substep);
  bool keeps_tension(int segment) const { return segment == winch_.segment && winch_.mode == WinchMode::keeps; }
  void factor_segments();
  void solve_segments();
  Vector3 corrected_load(int node) const;
  double force_along(int segment) const;
  void measure_end();
  bool changes_lengths(const Substep& substep) const;
  double stored_when_taut(const Substep& substep) const;
  void move(const Substep& substep);
  void restore_momenta(const Substep& substep, const std::vector<double>& masses);
  double restore_angular_momentum(const Substep& substep, const std::vector<double>& masses);
  void quieten(const Substep& substep, CableState& state, SubstepResult& result);
  void take_out_unresolved(const Substep& substep, CableState& state, SubstepResult& result);
  void assemble_for_velocities();
  void project(const Substep& substep, const std::vector<double>& masses, SubstepResult& result);
  void scale_to_lose(const Substep& substep);
  Vector3 projected_impulse_on(int node) const;
  double store(const Substep& substep, CableState& state) const;
  // What becomes of energy: rod/cable_balance.cpp
  void balance_laws(const Substep& substep, const std::vector<double>& masses, double given_back, SubstepResult& result) const;
  void balance_drag(const Substep& substep, const std::vector<double>& masses, EnergyBalance& balance) const;
  double work_of_loads(const Boundary& boundary) const;
  void balance_lengths(const Substep& substep, double given_back, SubstepResult& result) const;
  void balance_mended_growth(const GrowingSegment& growing, double impulse, SubstepResult& result) const;
  double kinetic_energy(const std::vector<double>& masses, const VectorArray& velocity) const;

  int segments_ = 0;
  bool any_elastic_ = false, any_rigid_ = false;         // among the segments
  bool drags_ = false;                                   // any material does
  std::vector<double> axial_stiffness_, axial_damping_;  // segments: EA [N], [N s]; of a cable that is not elastic not set
  // At the start of the substep
  VectorArray position_, velocity_, acceleration_;  // nodes: [m], [m/s], [m/s^2]
  VectorArray segment_;                             // segments: d [m]
  std::vector<double> length_;                      // segments: s [m]
  std::vector<double> start_density_;               // segments: 2 T / (s + s') of the substep before [N/m]
  std::vector<double> rest_growth_;                 // segments: of the rest length, in the substep [m]
  int winch_node_ = -1;                             // the end node at a winch that runs
  Vector3 material_way_ = Vector3::Zero();          // of the material there, in the substep [m]
  /// A winch that gives way to tension, in the present iterate.
  struct Winch {
    int segment = -1;  // -1: none does
    WinchLaw law;
    double planned_rest = 0;  // [m] the rest length, where forces are taken
    double planned_way = 0;   // [m] that it grows by
    double planned_left = 0;  // [m] of that from there on
    double rounded_way = 0;   // [m] by which that is more than what `rest_growth_` is planned to be
    double beyond = 0;        // [m] by which it grows more
    WinchMode mode = WinchMode::least;
    bool changed = false;  // whether the mode did in this iteration
    int changes = 0;       // of it, in the substep
  };
  Winch winch_;
  std::vector<double> target_length_;  // segments: l [m]; longer where bodies have drawn them out
  std::vector<OverstretchedSpan> overstretched_;
  std::vector<char> yields_;               // segments: of an overstretched span
  std::vector<double> inverse_mass_;       // nodes: [1/kg], 0 where held
  std::vector<double> inertia_;            // nodes: 2 m / h^2 and drag / h [kg/s^2]
  VectorArray base_load_;                  // nodes: gravity and inertia of the velocity [N]
  std::vector<double> strain_compliance_;  // segments: of the system's compliance, what tension strains; see set_loads
  std::vector<int> both_held_;             // segments between two held nodes that do not give way
  // The unknowns
  VectorArray displacement_;             // nodes: x' - x [m]
  std::vector<double> tension_density_;  // segments: 2 T / (s + s') [N/m]
  // Of the present iterate
  double compressed_part_ = 0.5;    // where in the substep compression acts along segments
  VectorArray middle_;              // segments: (d + d') / 2 [m]
  VectorArray segment_force_;       // segments: force on the first node [N]
  double bending_loss_ = 0;         // [J] that damping takes, of the solution
  VectorArray bending_force_;       // segments: of bending, of the solution [N]; where a winch runs
  std::vector<double> end_square_;  // segments: square of s' [m^2]
  VectorArray end_velocity_;        // nodes: v' [m/s]
  Bending bending_;
  Twist twist_;
  KirchhoffRod rod_;
  FluidForces fluid_;
  MotionCleaner cleaner_;
  KktSystem system_;
  bool couples_second_ = false;  // the system's couplings to second neighbours are set
  BlockElimination solver_;
  // Flows through guides
  std::vector<Flow> flows_;
  /// For each two flows j, k, of a unit of way of j: multipliers at k before and after it, and what moves along its column
  std::vector<double> flow_response_;
  VectorArray flow_node_load_;
  std::vector<double> flow_matrix_, flow_solution_, flow_gap_;
  // Loads that wait, and none
  VectorArray kept_load_;
  std::vector<double> kept_gap_, kept_torque_, kept_flow_load_, kept_ways_;
  KktSolution kept_solution_;
  // Velocity projection: a tridiagonal system
  std::vector<double> pivot_, off_, impulse_;  // segments
  std::vector<double> growth_;                 // segments: rate of half the square of the length [m^2/s]
};

/// At a winch what bends moves with the material, not with the node.
template <class Operation>
void CableStepper::with_material(const Operation& operation) {
  const int node = std::max(winch_node_, 0);
  const Vector3 displacement = get(displacement_, node);
  if (winch_node_ >= 0) set(displacement_, node, displacement + material_way_);
  operation();
  set(displacement_, node, displacement);
}

}  // namespace verlet_cable

#include "rod/cable_stepper.h"

#include <algorithm>
#include <cmath>

#include "chain/point_motion.h"
#include "geometry/eigen_vectors.h"
#include "law/drag.h"
#include "law/length_rate.h"
#include "law/resistance.h"
#include "rod/rigid_motion.h"
#include "rod/tridiagonal.h"
#include "verlet_cable/core/cable_materials.h"

namespace verlet_cable {

namespace {

constexpr int step_iterations = 40;
/// A correction that shrinks less than this from one iteration to the next calls for a new factorisation.
constexpr double slow_convergence = 0.1;
/// Of the lengths of such spans, relative.
constexpr double greatest_gap = 1e-7;
/// Of the first `count` numbers.
void add(const std::vector<double>& more, int count, std::vector<double>& sum) {
  const double* from = more.data();
  double* to = sum.data();
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) to[i] += from[i];
}

}  // namespace

void bring_to_rest(CableState& state) {
  std::fill(state.velocities.begin(), state.velocities.end(), Vector3::Zero());
  std::fill(state.accelerations.begin(), state.accelerations.end(), Vector3::Zero());
  begin_anew(state.unresolved);
  std::fill(state.spin.begin(), state.spin.end(), 0.0);
}

void CableStepper::resize(int segments) {
  if (segments == segments_) return;
  segments_ = segments;
  const int nodes = segments + 2;  // one more, where two are computed with together
  for (VectorArray* a : {&position_, &velocity_, &acceleration_, &segment_, &displacement_, &middle_, &segment_force_,
                         &bending_force_, &end_velocity_, &base_load_})
    a->assign(nodes, 0.0);
  for (std::vector<double>* a :
       {&length_, &rest_growth_, &target_length_, &inverse_mass_, &tension_density_, &inertia_, &end_square_, &start_density_,
        &pivot_, &off_, &impulse_, &growth_, &axial_stiffness_, &axial_damping_, &strain_compliance_})
    a->assign(nodes, 0.0);
  both_held_.reserve(nodes);
  yields_.assign(nodes, 0);
  kept_load_.assign(nodes, 0.0);
  kept_gap_.assign(nodes, 0.0);
  kept_torque_.assign(nodes, 0.0);
  kept_solution_.resize(segments_);
  bending_.resize(segments);
  twist_.resize(segments);
  rod_.resize(segments);
  fluid_.resize(segments + 1);
  cleaner_.resize(segments + 1);
  system_.resize(segments_);
  solver_.resize(segments_);
}

SubstepResult CableStepper::advance(const Substep& s, CableState& state) {
  SubstepResult result;
  begin(s, state, result);
  result.converged = solve(s, state, result);
  if (!result.converged && rod_.active()) {
    begin(s, state, result);
    rod_.simplify();
    result.converged = solve(s, state, result);
  }
  if (result.converged) finish(s, false, state, result);
  return result;
}

void CableStepper::begin(const Substep& s, const CableState& state, SubstepResult& result) {
  load(s, state);
  hold(s.boundary.nodes);
  flows_.resize(s.boundary.flows.size());
  for (std::size_t k = 0; k < flows_.size(); ++k) {
    flows_[k].first = s.boundary.flows[k].first;
    flows_[k].last = s.boundary.flows[k].last;
    flows_[k].before = flows_[k].first - 1;
    flows_[k].after = flows_[k].last;
  }
  result.overstretched_node =
      lengths_in_substep(s.model, state, s.boundary, s.drawn_out(), yielding_ahead(s, state), target_length_, overstretched_);
  fluid_.start(s, state);
  set_loads(s, state);
  set_growth(s);
  start_bending(s, state);
  start_flows(s, state);
  if (state.directors.empty())
    rod_.leave_out();
  else
    rod_.start(s.model, state, segment_, s.boundary, s.h, s.damping_time(), s.part());
  twist_.start(s.model, state, s.spans, s.damping_time(), s.part());
  predict(s.h);
  predict_flows(s);
}

void CableStepper::finish(const Substep& s, bool struck, CableState& state, SubstepResult& result) {
  if (s.statics)
    for (int i = 0; i <= segments_; ++i) result.displacement = std::max(result.displacement, get(displacement_, i).norm());
  react(s, state.masses);
  const double stored = stored_when_taut(s);
  if (!s.statics) {
    if (changes_lengths(s)) measure_end();
    if (winch_.segment >= 0) finish_winch(s);
    balance_laws(s, state.masses, state.taut_energy - stored, result);
  }
  state.taut_energy = stored;
  move(s);
  finish_flows(s, state);
  // What a conserving substep has at its end; what is taken from there on it does not resolve.
  const bool is_balanced = !s.statics && s.scheme == Scheme::conserving;
  if (is_balanced) result.balance.dissipated.unresolved += kinetic_energy(state.masses, end_velocity_);
  const bool damped = !s.statics && s.scheme != Scheme::conserving;
  if (damped && s.boundary.nodes.empty()) restore_momenta(s, state.masses);
  if (!s.statics && s.boundary.nodes.empty()) {
    const double given_back = restore_angular_momentum(s, state.masses);
    result.balance.dissipated.bending -= given_back;
    if (is_balanced) result.balance.dissipated.unresolved += given_back;
  }
  // Where bodies give way they are projected together.
  if (!s.statics && !s.boundary.is_on_bodies() &&
      (struck || damped || !s.boundary.growing.empty() || holders_accelerate(s, state)))
    project(s, state.masses, result);
  result.max_strain = store(s, state);
  if (rod_.active()) rod_.store(s.boundary, state);
  if (rod_.active() && !flows_.empty()) carry_frames_with_flows(s.model, state);
  if (s.treatment != Treatment::none) quieten(s, state, result);
  if (twist_.active()) twist_.follow(s.boundary.directions, state.positions, s.spans);
  if (!is_balanced) return;
  for (int i = 0; i <= segments_; ++i) set(end_velocity_, i, state.velocities[i]);
  result.balance.dissipated.unresolved -= kinetic_energy(state.masses, end_velocity_);
}

void CableStepper::load(const Substep& s, const CableState& state) {
  const CableMaterials materials(s.model, state);
  any_elastic_ = materials.any_elastic();
  any_rigid_ = materials.any_rigid();
  for (int i = 0; any_elastic_ && i < segments_; ++i) {
    axial_stiffness_[i] = materials[i].axial_stiffness;
    axial_damping_[i] = materials[i].axial_damping;
  }
  for (int i = 0; i <= segments_; ++i) {
    set(position_, i, state.positions[i]);
    set(velocity_, i, s.statics ? Vector3::Zero() : state.velocities[i]);
    set(acceleration_, i, s.statics ? Vector3::Zero() : state.accelerations[i]);
    system_.movable[i] = 1;
  }
  for (int i = 0; i < segments_; ++i) {
    const Vector3 d = state.positions[i + 1] - state.positions[i];
    set(segment_, i, d);
    length_[i] = is_elastic_at(i) ? d.norm() : state.rest_lengths[i];
    tension_density_[i] = start_density_[i] = state.axial_multiplier[i] / length_[i];
  }
}

/// Sets what is known of the held nodes.
void CableStepper::hold(const std::vector<HeldNode>& held) {
  for (const HeldNode& target : held) {
    system_.movable[target.node] = 0;
    set(displacement_, target.node, target.position - get(position_, target.node));
  }
}

/// The parts of the equations of motion that no iteration changes.
void CableStepper::set_loads(const Substep& s, const CableState& state) {
  const CableMaterials materials(s.model, state);
  drags_ = materials.any([](const MaterialDesc& material) { return material.drag > 0; });
  const LinearDrag<double> of_fluid{1, numbers_of(s.environment.fluid.velocity), 1 / s.damping_time()};
  double drag_of_material = s.model.material.drag;
  const GravityDesc& gravity = s.environment.gravity;
  const bool is_uniform = gravity.type == GravityDesc::Type::uniform;
  Vector3 g = gravity.acceleration;
  double half_before = 0;
  for (int i = 0; i <= segments_; ++i) {
    const double mass = state.masses[i], inertia = s.inertia() * mass / s.h;
    const double half = i < segments_ ? 0.5 * state.rest_lengths[i] : 0, length = half_before + half;
    half_before = half;
    if (materials.vary()) drag_of_material = materials.mean_at(i, [](const MaterialDesc& material) { return material.drag; });
    LinearDrag<double> drag = of_fluid;
    if (fluid_.active()) drag.fluid = numbers_of(fluid_.flow(i));
    drag.coefficient = drag_of_material * length;
    inertia_[i] = inertia / s.h + drag.resistance();
    const VectorOf<double> wind = drag.load();
    // In the middle of the substep, where the other forces are; velocities are zero in statics.
    if (!is_uniform) g = gravity.at(get(position_, i) + 0.5 * s.h * get(velocity_, i));
    base_load_.x[i] = mass * g.x() + inertia * velocity_.x[i] + wind.x;
    base_load_.y[i] = mass * g.y() + inertia * velocity_.y[i] + wind.y;
    base_load_.z[i] = mass * g.z() + inertia * velocity_.z[i] + wind.z;
  }
  for (const NodeLoad& load : s.boundary.loads) set(base_load_, load.node, get(base_load_, load.node) + load.force);
  const std::vector<HeldNode>& held = s.boundary.nodes;
  std::fill_n(system_.compliance.begin(), segments_, 0.0);
  std::fill_n(strain_compliance_.begin(), segments_, 0.0);
  if (held.size() > 1 && any_rigid_) {
    const double stiffness = stiffness_of_taut(s, state);
    const double stiffness_on_bodies = s.gives_in_on_bodies ? stiffness_of_overstretched(s, state) : stiffness;
    for (std::size_t k = 0; k + 1 < held.size(); ++k) {
      // What can stretch has a tension.
      if (materials.any_elastic_between(held[k].node, held[k + 1].node)) continue;
      // What is pulled straight from a junction to a frame may have no room to give way.
      const auto moves_freely = [](const HeldNode& node) { return node.body >= 0 && !node.at_junction; };
      const bool gives_way = moves_freely(held[k]) || moves_freely(held[k + 1]);
      for (int i = held[k].node; i < held[k + 1].node; ++i) {
        system_.compliance[i] = taut_compliance(target_length_[i], gives_way ? stiffness_on_bodies : stiffness);
        if (!gives_way || s.strains_on_bodies) strain_compliance_[i] = system_.compliance[i];
      }
    }
  }
  std::fill_n(yields_.begin(), segments_, 0);
  for (const OverstretchedSpan& span : overstretched_) {
    const double compliance = compliance_of(span, s, state);
    for (int i = span.first; i < span.last; ++i) {
      yields_[i] = 1;
      system_.compliance[i] += target_length_[i] * target_length_[i] * target_length_[i] * compliance;
      strain_compliance_[i] = system_.compliance[i];
    }
  }
  both_held_.clear();
  for (std::size_t k = 0; k + 1 < held.size(); ++k)
    if (held[k].node + 1 == held[k + 1].node && held[k].body == held[k + 1].body && !grows(held[k].node) &&
        !is_elastic_at(held[k].node) && yields_[held[k].node] == 0)
      both_held_.push_back(held[k].node);
}

bool CableStepper::keeps_lengths() const {
  for (int i = 0; i < segments_; ++i)
    if (system_.compliance[i] > 0 && !grows(i) && !keeps_tension(i) &&
        !(std::abs(system_.gap[i]) < greatest_gap * target_length_[i] * target_length_[i]))
      return false;
  return true;
}

double CableStepper::greatest_tension_of_taut() const {
  double greatest = 0;
  for (int i = 0; i < segments_; ++i)
    if (system_.compliance[i] > 0 && !keeps_tension(i)) greatest = std::max(greatest, tension_density_[i] * target_length_[i]);
  return greatest;
}

/// At a winch the material moves through the end node.
void CableStepper::set_growth(const Substep& s) {
  std::fill_n(rest_growth_.begin(), segments_, 0.0);
  winch_node_ = -1;
  winch_.segment = -1;
  for (const GrowingSegment& growing : s.boundary.growing) {
    const int i = growing.segment;
    rest_growth_[i] = s.h * growing.growth;
    if (growing.law.gives()) start_winch(growing);
    if (i != 0 && i + 1 != segments_) continue;
    winch_node_ = i == 0 ? 0 : segments_;
    const double way = i == winch_.segment ? winch_.planned_way + winch_.beyond : rest_growth_[i];
    material_way_ = (i == 0 ? way : -way) * get(segment_, i).normalized();
  }
}

/// The material's segment at a winch is as long at the start as it is unstrained in the substep: growth is no bending.
void CableStepper::start_bending(const Substep& s, const CableState& state) {
  const int i = std::clamp(winch_node_ - 1, 0, segments_ - 1);
  const Vector3 segment = get(segment_, i);
  const double part = is_elastic_at(i) && s.scheme == Scheme::conserving ? 0.5 : 1;
  if (winch_node_ >= 0) set(segment_, i, segment + (winch_node_ == 0 ? part : -part) * material_way_);
  bending_.start(s.model, state, segment_, s.boundary.directions, s.damping_time(), s.part());
  set(segment_, i, segment);
  if (!bending_.active() && couples_second_) std::fill(system_.second.begin(), system_.second.end(), 0.0);
  couples_second_ = bending_.active();
}

/// At a winch what bends moves with the material, not with the node.
template <class Operation>
void CableStepper::with_material(const Operation& operation) {
  const int node = std::max(winch_node_, 0);
  const Vector3 displacement = get(displacement_, node);
  if (winch_node_ >= 0) set(displacement_, node, displacement + material_way_);
  operation();
  set(displacement_, node, displacement);
}

/// First guess: the motion goes on as in the last substep.
void CableStepper::predict(double h) {
  for (int i = 0; i <= segments_; ++i) {
    if (system_.movable[i] == 0) continue;
    displacement_.x[i] = h * (velocity_.x[i] + 0.5 * h * acceleration_.x[i]);
    displacement_.y[i] = h * (velocity_.y[i] + 0.5 * h * acceleration_.y[i]);
    displacement_.z[i] = h * (velocity_.z[i] + 0.5 * h * acceleration_.z[i]);
  }
}

/// Newton's method on places and tensions together, its matrix kept as long as it converges fast.
bool CableStepper::solve(const Substep& s, const CableState& state, SubstepResult& result) {
  Convergence convergence(s);
  bool stale = true;
  for (int i = 0; i < step_iterations; ++i) {
    evaluate(s, state);
    if (stale || calls_for_matrix()) {
      assemble(s.part());
      factor();
    }
    solve_linear();
    ++result.iterations;
    const double size = correct();
    if (!(size < largest_correction)) return false;
    if (convergence.is_reached(size) && flows_are_consistent(s) &&
        !convergence.lacks(std::abs(missing_work_of_tension(s.part())), told_energy(s, state)))
      return true;
    stale = i > 0 && convergence.ratio() > slow_convergence;
  }
  return false;
}

/// Residuals of the equations of motion and of the tension laws at the present iterate.
void CableStepper::evaluate(const Substep& s, const CableState& state) {
  if (!flows_.empty()) set_flow_lengths(s);
  std::fill(end_square_.begin(), end_square_.end(), 0.0);
  // Compression that acted along the end of a segment that turns would make energy: its work there is more than the force times
  // the change of length. In the middle they are the same. On bodies it acts with the arms that those have at the end.
  compressed_part_ = s.statics || s.boundary.is_on_bodies() ? s.part() : 0.5;
  for (auto component : {&VectorArray::x, &VectorArray::y, &VectorArray::z}) evaluate_segments(s.part(), component);
  if (bending_.active()) with_material([&] { bending_.add_segment_forces(displacement_, segment_force_); });
  if (rod_.active()) rod_.add_segment_forces(displacement_, segment_, middle_, segment_force_);
  if (twist_.active()) twist_.add_segment_forces(middle_, displacement_, s.boundary, segment_force_);
  if (any_elastic_)
    evaluate_elastic_lengths(s, state.rest_lengths);
  else
    evaluate_rigid_lengths();
  if (winch_.segment >= 0) evaluate_winch(s);
  for (const int i : both_held_) {
    if (keeps_tension(i)) continue;
    system_.gap[i] = 0;
    system_.compliance[i] = 1;
  }
  for (auto component : {&VectorArray::x, &VectorArray::y, &VectorArray::z}) evaluate_nodes(component);
  if (fluid_.active()) fluid_.add_loads(state.rest_lengths, middle_, position_, displacement_, system_.load);
  if (!flows_.empty()) evaluate_flows(s);
}

void CableStepper::evaluate_segments(double part, Component component) {
  const double *u = (displacement_.*component).data(), *d = (segment_.*component).data(), *density = tension_density_.data();
  const double compressed = compressed_part_;
  double *mid = (middle_.*component).data(), *f = (segment_force_.*component).data(), *square = end_square_.data();
#pragma GCC ivdep
  for (int i = 0; i < segments_; ++i) {
    const double change = u[i + 1] - u[i];
    const double end = d[i] + change;
    mid[i] = d[i] + (density[i] < 0 ? compressed : part) * change;
    f[i] = density[i] * mid[i];
    square[i] += end * end;
  }
}

void CableStepper::evaluate_nodes(Component component) {
  const double *u = (displacement_.*component).data(), *b = (base_load_.*component).data(),
               *f = (segment_force_.*component).data();
  const double* inertia = inertia_.data();
  double* r = (system_.load.*component).data();
  r[0] = b[0] - inertia[0] * u[0] + f[0];
#pragma GCC ivdep
  for (int i = 1; i < segments_; ++i) r[i] = b[i] - inertia[i] * u[i] + (f[i] - f[i - 1]);
  r[segments_] = b[segments_] - inertia[segments_] * u[segments_] - f[segments_ - 1];
}

void CableStepper::evaluate_rigid_lengths() {
#pragma GCC ivdep
  for (int i = 0; i < segments_; ++i) evaluate_rigid_length(i);
}

/// `compliance`: what `set_loads` has set.
inline void CableStepper::evaluate_rigid_length(int i) {
  system_.gap[i] = inextensible_row(end_square_[i], target_length_[i], strain_compliance_[i], tension_density_[i]).gap;
}

void CableStepper::evaluate_elastic_lengths(const Substep& sub, const std::vector<double>& rest_lengths) {
  for (int i = 0; i < segments_; ++i) {
    if (any_rigid_ && !is_elastic_at(i))
      evaluate_rigid_length(i);
    else
      evaluate_elastic_length(sub, i, rest_lengths[i]);
  }
}

/// `rest`: the rest length where forces are taken [m].
void CableStepper::evaluate_elastic_length(const Substep& sub, int i, double rest) {
  const double part = sub.part(), end = std::sqrt(end_square_[i]), mean = length_[i] + part * (end - length_[i]);
  const Straining strained = straining(sub, i);
  const Resistance<double> resistance{axial_stiffness_[i] / rest, axial_damping_[i] / (sub.damping_time() * strained.end)};
  set_row(i, elastic_row(resistance.stress(mean - rest, strained.growth), resistance.slope(part), tension_density_[i], mean, end,
                         part));
}

void CableStepper::set_row(int i, const LengthRow<double>& row) {
  system_.gap[i] = row.gap;
  system_.compliance[i] = row.compliance;
}

/// With lengths s, s' and rest lengths l, l' at the start and (') the end. What flows in or is wound is strained already.
CableStepper::Straining CableStepper::straining(const Substep& s, int i) const {
  Straining found;
  found.end = target_length_[i];
  if (rest_growth_[i] != 0)
    for (const GrowingSegment& wound : s.boundary.growing)
      if (wound.segment == i) found.end += (1 - s.part()) * s.h * wound.growth;
  if (i == winch_.segment) {
    const WoundLength wound = wound_length(s);
    found.start = wound.start_rest;
    found.end = wound.end_rest + winch_.beyond;
    found.growth = std::sqrt(end_square_[i]) - length_[i] * found.end / found.start;
    return found;
  }
  found.start = found.end - rest_growth_[i];
  found.growth = std::sqrt(end_square_[i]) - length_[i];
  if (rest_growth_[i] != 0) found.growth -= length_[i] * rest_growth_[i] / found.start;
  return found;
}

void CableStepper::assemble(double part) {
  assemble_segments(part, tension_density_, middle_);
  if (bending_.active()) bending_.add_stiffness(system_);
  if (rod_.active()) rod_.assemble(middle_, tension_density_);
  if (fluid_.active()) fluid_.add_stiffness(system_.diagonal);
}

/// Inertia, and tension in segments of these directions [m].
void CableStepper::assemble_segments(double part, const std::vector<double>& density, const VectorArray& direction) {
  system_.clear_stiffness();
  std::copy_n(inertia_.begin(), segments_ + 1, system_.diagonal.begin());
  for (int i = 0; i < segments_; ++i) {
    // A rod's tension resists the rotation of its segments.
    const double stiffness = rod_.active() ? 0 : (density[i] < 0 ? compressed_part_ : part) * density[i];
    system_.diagonal[i] += stiffness;
    system_.diagonal[i + 1] += stiffness;
    system_.first[i] = -stiffness;
    system_.direction.x[i] = direction.x[i];
    system_.direction.y[i] = direction.y[i];
    system_.direction.z[i] = direction.z[i];
  }
}

void CableStepper::factor() {
  factor_segments();
  if (!flows_.empty()) factor_flows();
}

void CableStepper::factor_segments() {
  if (rod_.active())
    rod_.factor(system_);
  else
    solver_.factor(system_, bending_.active());
}

void CableStepper::solve_linear() {
  solve_segments();
  if (!flows_.empty()) let_flow();
}

void CableStepper::solve_segments() {
  if (rod_.active())
    rod_.solve(system_);
  else
    solver_.solve(system_);
}

const VectorArray& CableStepper::correction() const {
  return rod_.active() ? rod_.elimination().displacement() : solver_.displacement();
}

const std::vector<double>& CableStepper::multiplier_correction() const {
  return rod_.active() ? rod_.elimination().multiplier() : solver_.multiplier();
}

void CableStepper::set_correction(const VectorArray& displacement, const std::vector<double>& multiplier) {
  solver_.set_solution(displacement, multiplier);
  // The way is what the rows of the segments that grow lack.
  for (Flow& flow : flows_) {
    const int side = keeps_tension(flow.after) ? 0 : 1, i = side == 0 ? flow.before : flow.after;
    const Vector3 between = get(displacement, i + 1) - get(displacement, i);
    const double lacking = get(system_.direction, i).dot(between) - system_.compliance[i] * multiplier[i] - system_.gap[i];
    flow.correction = lacking / flow.gap[side];
  }
}

/// Applies the solution; the largest correction, in segment lengths or angles.
double CableStepper::correct() {
  const VectorArray& delta = correction();
  for (auto component : {&VectorArray::x, &VectorArray::y, &VectorArray::z})
    add(delta.*component, segments_ + 1, displacement_.*component);
  add(multiplier_correction(), segments_, tension_density_);
  if (!flows_.empty() && !correct_flows(1)) return infinity;
  Pair largest{}, sum{};
  for (int i = 0; i <= segments_; i += 2) {
    const PairVector d = neighbours(delta, i);
    const Pair square = dot(d, d);
    largest = square <= largest ? largest : square;
    sum += square;
  }
  // A NaN may be lost among squares, but not in their sum.
  const double size = std::sqrt(std::max(largest[0], largest[1])) / target_length_[0] + 0 * (sum[0] + sum[1]);
  if (!rod_.active()) return size;
  return larger(size, rod_.correct(1));
}

void CableStepper::follow_holders(const Boundary& boundary) {
  hold(boundary.nodes);
  if (rod_.active()) rod_.follow_clamps(boundary);
}

void CableStepper::read_holder_loads(const Substep& s, const std::vector<double>& masses, bool corrected,
                                     HolderLoads& loads) const {
  const Boundary& boundary = s.boundary;
  loads.forces.resize(boundary.nodes.size());
  loads.torques.assign(boundary.directions.size(), Vector3::Zero());
  for (std::size_t k = 0; k < boundary.nodes.size(); ++k) {
    const int i = boundary.nodes[k].node;
    const Vector3 load = corrected ? corrected_load(i) : get(system_.load, i);
    loads.forces[k] = load + s.inertia() * masses[i] / s.h * (get(displacement_, i) / s.h - get(velocity_, i));
    if (!flows_.empty()) loads.forces[k] += flow_reaction(s, i);
  }
  if (!rod_.active()) return;
  rod_.add_clamp_torques(loads.torques);
  if (corrected) rod_.add_clamp_reactions(system_, loads.torques);
}

void CableStepper::add_moved(const Boundary& boundary, const HolderMotion& motion) {
  solve_for_motion(boundary, motion);
  solution().add(kept_solution_);
  for (std::size_t k = 0; k < flows_.size(); ++k) flows_[k].correction += kept_ways_[k];
  // What clamps that turn exert on the nodes beside them.
  for (auto component : {&VectorArray::x, &VectorArray::y, &VectorArray::z})
    add(system_.load.*component, segments_ + 1, kept_load_.*component);
  exchange_loads();
}

void CableStepper::respond(const Boundary& boundary, const HolderMotion& motion, HolderLoads& loads) {
  solve_for_motion(boundary, motion);
  loads.forces.resize(boundary.nodes.size());
  loads.torques.assign(boundary.directions.size(), Vector3::Zero());
  system_.moves_held = true;
  for (std::size_t k = 0; k < boundary.nodes.size(); ++k) {
    const int i = boundary.nodes[k].node;
    loads.forces[k] = corrected_load(i);
    if (!rod_.active()) loads.forces[k] -= (system_.diagonal[i] - inertia_[i]) * motion.displacements[k];
    if (system_.stiffened) loads.forces[k] -= get(system_.added, i) * motion.displacements[k];
  }
  if (rod_.active()) rod_.add_clamp_reactions(system_, loads.torques);
  loads.displacements.resize(motion.loads.size());
  for (std::size_t k = 0; k < motion.loads.size(); ++k) loads.displacements[k] = at_point(motion.loads[k].point, correction());
  system_.moves_held = false;
  std::swap(solution(), kept_solution_);
  for (std::size_t k = 0; k < flows_.size(); ++k) flows_[k].correction = kept_ways_[k];
  exchange_loads();
}

/// Leaves the loads and the solution that were there in those that are kept.
void CableStepper::solve_for_motion(const Boundary& boundary, const HolderMotion& motion) {
  exchange_loads();
  std::swap(solution(), kept_solution_);
  kept_ways_.resize(flows_.size());
  for (std::size_t k = 0; k < flows_.size(); ++k) kept_ways_[k] = flows_[k].correction;
  system_.flow_load.assign(flows_.size(), 0.0);
  system_.load.assign(segments_ + 2, 0.0);
  system_.gap.assign(segments_ + 2, 0.0);
  rod_.torque().assign(segments_ + 2, 0.0);
  for (std::size_t k = 0; k < boundary.nodes.size(); ++k)
    set(system_.held_displacement, boundary.nodes[k].node, motion.displacements[k]);
  if (rod_.active()) rod_.add_clamp_loads(motion.rotations, system_);
  for (const PointLoad& load : motion.loads) add_force(load.point, load.force, system_.load);
  system_.moves_held = true;
  solve_linear();
  system_.moves_held = false;
}

void CableStepper::exchange_loads() {
  std::swap(system_.load, kept_load_);
  std::swap(system_.gap, kept_gap_);
  std::swap(rod_.torque(), kept_torque_);
  std::swap(system_.flow_load, kept_flow_load_);
}

void CableStepper::begin_projection(const Substep& s, const CableState& state) {
  rod_.leave_out();
  couples_second_ = true;  // whatever bends next sets them anew
  system_.clear_stiffness();
  std::fill(system_.second.begin(), system_.second.end(), 0.0);
  for (int i = 0; i <= segments_; ++i) {
    inertia_[i] = system_.diagonal[i] = state.masses[i];
    set(system_.load, i, Vector3::Zero());
  }
  for (int i = 0; i < segments_; ++i) {
    const Vector3 d = state.positions[i + 1] - state.positions[i];
    set(system_.direction, i, d);
    system_.first[i] = 0;
    const double compliance = d.squaredNorm() / (state.masses[i] + state.masses[i + 1]);
    const bool stretches = is_elastic_at(i) || yields_[i] != 0 || keeps_tension(i);
    system_.compliance[i] = (stretches ? 1 / length_rate_regularisation : length_rate_regularisation) * compliance;
    system_.gap[i] = stretches ? 0 : d.dot(state.velocities[i] - state.velocities[i + 1]);
  }
  for (const GrowingSegment& growing : s.boundary.growing)
    if (!is_elastic_at(growing.segment) && !growing.keeps_tension)
      system_.gap[growing.segment] += state.rest_lengths[growing.segment] * growing.growth;
  if (!flows_.empty()) begin_flow_projection(s, state);
  for (const int i : both_held_) system_.gap[i] = 0;
  solver_.factor(system_, false);
  if (!flows_.empty()) factor_flows();
}

void CableStepper::read_impulses(const Boundary& boundary, HolderLoads& impulses) const {
  impulses.forces.resize(boundary.nodes.size());
  impulses.torques.assign(boundary.directions.size(), Vector3::Zero());
  for (std::size_t k = 0; k < boundary.nodes.size(); ++k) impulses.forces[k] = corrected_load(boundary.nodes[k].node);
}

void CableStepper::finish_projection(const Substep& s, CableState& state, SubstepResult& result) {
  const VectorArray& change = solver_.displacement();
  for (int i = 0; i <= segments_; ++i) {
    state.velocities[i] += get(change, i);
    state.accelerations[i] += get(change, i) / s.h;
  }
  for (HeldNode& held : s.boundary.nodes) {
    held.mend(corrected_load(held.node) / s.h, 1);
    if (held.body < 0) continue;
    held.velocity += get(change, held.node);
    held.force -= state.masses[held.node] / s.h * get(change, held.node);
  }
  for (std::size_t k = 0; k < flows_.size(); ++k) mend_flow(flows_[k], flows_[k].correction, s.boundary.flows[k], result);
  for (const GrowingSegment& growing : s.boundary.growing)
    if (!is_elastic_at(growing.segment) && !growing.keeps_tension)
      balance_mended_growth(growing, -multiplier_correction()[growing.segment], result);
}

void CableStepper::take_back(double part) {
  const VectorArray& delta = correction();
  for (int i = 0; i <= segments_; ++i) set(displacement_, i, get(displacement_, i) - part * get(delta, i));
  for (int i = 0; i < segments_; ++i) tension_density_[i] -= part * multiplier_correction()[i];
  if (!flows_.empty()) correct_flows(-part);
  if (rod_.active()) rod_.correct(-part);
}

/// The lengths of the solution, which the last iterate did not have yet.
void CableStepper::measure_end() {
  for (int i = 0; i < segments_; ++i)
    end_square_[i] = (get(segment_, i) + get(displacement_, i + 1) - get(displacement_, i)).squaredNorm();
}

void CableStepper::move(const Substep& s) {
  const VelocityWeights weights = velocity_weights(s.scheme);
  const double rate = s.statics ? 0 : weights.displacement / s.h;
  if (s.scheme == Scheme::conserving) {
    for (int i = 0; i <= segments_; ++i) {
      end_velocity_.x[i] = rate * displacement_.x[i] - velocity_.x[i];
      end_velocity_.y[i] = rate * displacement_.y[i] - velocity_.y[i];
      end_velocity_.z[i] = rate * displacement_.z[i] - velocity_.z[i];
    }
  } else {
    for (int i = 0; i <= segments_; ++i)
      set(end_velocity_, i,
          rate * get(displacement_, i) + weights.velocity * get(velocity_, i) +
              weights.acceleration * s.h * get(acceleration_, i));
  }
  for (int i = 0; i <= segments_; ++i) {
    position_.x[i] += displacement_.x[i];
    position_.y[i] += displacement_.y[i];
    position_.z[i] += displacement_.z[i];
  }
  for (const HeldNode& target : s.boundary.nodes) {
    set(position_, target.node, target.position);
    set(end_velocity_, target.node, s.statics ? Vector3::Zero() : target.velocity);
  }
  for (int i = 0; i < segments_; ++i) {
    segment_.x[i] = position_.x[i + 1] - position_.x[i];
    segment_.y[i] = position_.y[i + 1] - position_.y[i];
    segment_.z[i] = position_.z[i + 1] - position_.z[i];
  }
}

/// Impulses along inextensible segments that end all change of length but that of rest lengths; without them such velocities
/// would alternate from step to step.
void CableStepper::project(const Substep& s, const std::vector<double>& masses, SubstepResult& result) {
  if (!any_rigid_) return;
  const int n = segments_;
  for (int i = 0; i <= n; ++i) inverse_mass_[i] = system_.movable[i] / masses[i];
  std::fill(pivot_.begin(), pivot_.end(), 0.0);
  std::fill(off_.begin(), off_.end(), 0.0);
  std::fill(impulse_.begin(), impulse_.end(), 0.0);
  for (auto component : {&VectorArray::x, &VectorArray::y, &VectorArray::z}) {
    const double *d = (segment_.*component).data(), *v = (end_velocity_.*component).data();
    double *square = pivot_.data(), *product = off_.data(), *rate = impulse_.data();
#pragma GCC ivdep
    for (int i = 0; i < n; ++i) {
      square[i] += d[i] * d[i];
      product[i] += d[i] * d[i + 1];  // the last one is not used
      rate[i] += d[i] * (v[i] - v[i + 1]);
    }
  }
  for (int i = 0; i < n; ++i) {
    pivot_[i] = length_rate_diagonal(pivot_[i], inverse_mass_[i] + inverse_mass_[i + 1]);
    off_[i] = length_rate_coupling(off_[i], inverse_mass_[i + 1]);
  }
  for (const GrowingSegment& growing : s.boundary.growing)
    impulse_[growing.segment] += target_length_[growing.segment] * growing.growth;
  for (const int i : both_held_) {
    pivot_[i] = 1;
    impulse_[i] = 0;
  }
  for (int i = 0; (any_elastic_ || !overstretched_.empty()) && i < n; ++i) {
    if (!is_elastic_at(i) && yields_[i] == 0) continue;
    pivot_[i] = 1;
    off_[i] = off_[std::max(i - 1, 0)] = impulse_[i] = 0;
  }
  if (winch_.segment >= 0 && keeps_tension(winch_.segment) && !grows(winch_.segment)) {
    const int i = winch_.segment;
    pivot_[i] = 1;
    off_[i] = off_[std::max(i - 1, 0)] = impulse_[i] = 0;
  }
  if (!flows_.empty()) project_flows(s);
  growth_ = impulse_;
  solve_tridiagonal(pivot_, off_, impulse_, n);
  scale_to_lose(s);
  if (!flows_.empty()) push_flows(s, result);
  for (const GrowingSegment& growing : s.boundary.growing) balance_mended_growth(growing, impulse_[growing.segment], result);
  for (auto component : {&VectorArray::x, &VectorArray::y, &VectorArray::z}) {
    const double *d = (segment_.*component).data(), *w = inverse_mass_.data(), *impulse = impulse_.data();
    double* v = (end_velocity_.*component).data();
    v[0] -= w[0] * impulse[0] * d[0];
#pragma GCC ivdep
    for (int i = 1; i < n; ++i) v[i] += w[i] * (impulse[i - 1] * d[i - 1] - impulse[i] * d[i]);
    v[n] += w[n] * impulse[n - 1] * d[n - 1];
  }
  const double lasting_part = s.scheme == Scheme::damped ? 0 : 1;
  for (HeldNode& target : s.boundary.nodes) target.mend(projected_impulse_on(target.node) / s.h, lasting_part);
}

/// Where holders would make energy, no more of the impulses acts than makes none.
void CableStepper::scale_to_lose(const Substep& s) {
  double ended = 0;
  for (int i = 0; i < segments_; ++i) ended += impulse_[i] * growth_[i];
  const double share =
      losing_share_of_projection(s.boundary.nodes, s.h, ended, [&](int node) { return projected_impulse_on(node); });
  for (int i = 0; i < segments_; ++i) impulse_[i] *= share;
}

/// What the segments exert on the other nodes they exert on the holders: on a held node [N s].
Vector3 CableStepper::projected_impulse_on(int node) const {
  Vector3 impulse = Vector3::Zero();
  if (node > 0) impulse += impulse_[node - 1] * get(segment_, node - 1);
  if (node < segments_) impulse -= impulse_[node] * get(segment_, node);
  return impulse;
}

/// Substeps that damp keep momenta to second order. Those of a free cable are kept exactly: what is missing is given back as a
/// rigid body's motion.
void CableStepper::restore_momenta(const Substep& s, const std::vector<double>& masses) {
  const Vector3 center = center_of_mass(masses, position_), way = center_of_mass(masses, displacement_);
  Vector3 momentum = Vector3::Zero(), angular_momentum = Vector3::Zero();
  for (int i = 0; i <= segments_; ++i) {
    const Vector3 u = get(displacement_, i), v = get(velocity_, i), end = get(end_velocity_, i);
    const Vector3 arm = get(position_, i) - center, start_arm = arm - (u - way);
    const Vector3 gain = s.inertia() * (u / s.h - v);  // what the forces have done
    momentum += masses[i] * (v + gain - end);
    angular_momentum += masses[i] * (start_arm.cross(v) + arm.cross(gain - end));
  }
  const RigidMotion missing = rigid_motion(masses, position_, momentum, angular_momentum);
  for (int i = 0; i <= segments_; ++i) set(end_velocity_, i, get(end_velocity_, i) + missing.at(get(position_, i)));
}

/// Bending that is damped moves no free cable as a whole; what it did to the angular momentum is given back as a rigid body's
/// motion, but no more energy than it took. Returns that [J].
double CableStepper::restore_angular_momentum(const Substep& s, const std::vector<double>& masses) {
  const Vector3 taken = s.h * bending_.damping_torque(displacement_);
  if (taken.isZero(0)) return 0;
  const RigidMotion missing = rigid_motion(masses, position_, Vector3::Zero(), -taken);
  double along = 0, square = 0;  // a share of it adds share * along + share^2 * square [J]
  for (int i = 0; i <= segments_; ++i) {
    const Vector3 given = missing.at(get(position_, i));
    along += masses[i] * given.dot(get(end_velocity_, i));
    square += 0.5 * masses[i] * given.squaredNorm();
  }
  const double work = std::max(0.0, bending_.damping_work(displacement_));
  double share = 1;
  if (along + square > work) share = (std::sqrt(along * along + 4 * square * work) - along) / (2 * square);
  for (int i = 0; i <= segments_; ++i) set(end_velocity_, i, get(end_velocity_, i) + share * missing.at(get(position_, i)));
  return share * (along + share * square);
}

/// Finds motion that the substep has not resolved: it is taken out of the velocities, or the next substeps damp it.
void CableStepper::quieten(const Substep& s, CableState& state, SubstepResult& result) {
  // Its spin is a part of the angular momentum that a free rod keeps. One that was let go is not damped any longer.
  if (rod_.active() && s.boundary.nodes.empty()) return begin_anew(state.unresolved);
  if (!cleaner_.finds_unresolved(s.treatment, system_.movable, acceleration_, state)) return;
  if (s.treatment == Treatment::damping || s.scheme != Scheme::conserving) {
    state.unresolved.damped = s.scheme == Scheme::conserving ? damped_substeps : damped_substeps - 1;
    return;
  }
  take_out_unresolved(s, state, result);
}

void CableStepper::clean(const Substep& s, const std::vector<double>& start_multiplier, CableState& state) {
  SubstepResult unused;
  begin(s, state, unused);
  displacement_.assign(segments_ + 2, 0.0);
  end_velocity_ = velocity_;
  evaluate(s, state);
  for (int i = 0; i < segments_; ++i) start_density_[i] = start_multiplier[i] / length_[i];
  take_out_unresolved(s, state, unused);
}

void CableStepper::take_out_unresolved(const Substep& s, CableState& state, SubstepResult& result) {
  assemble_for_velocities();
  factor_segments();
  std::fill(growth_.begin(), growth_.end(), 0.0);
  for (const GrowingSegment& growing : s.boundary.growing)
    growth_[growing.segment] = target_length_[growing.segment] * growing.growth;
  for (std::size_t k = 0; k < flows_.size(); ++k) {
    const double rate = s.boundary.flows[k].rate;
    growth_[flows_[k].before] -= target_length_[flows_[k].before] * rate;
    growth_[flows_[k].after] += target_length_[flows_[k].after] * rate;
  }
  cleaner_.load(s.h, s.model, state, inertia_, segment_, end_velocity_, growth_, system_);
  for (const int i : both_held_) system_.gap[i] = 0;
  if (rod_.active()) std::fill(rod_.torque().begin(), rod_.torque().end(), 0.0);
  solve_segments();
  // What is taken out is what forces in the cable do: its holders feel them, too.
  double work = 0;
  for (const HeldNode& held : s.boundary.nodes) work -= 0.5 * s.h * corrected_load(held.node).dot(held.displacement);
  // At a winch, the material's way is that of what it holds.
  double of_winches = 0;
  if (winch_node_ >= 0) of_winches -= 0.5 * s.h * corrected_load(winch_node_).dot(material_way_);
  work += of_winches;
  const double share = cleaner_.take_out(s.h, work, s.boundary.nodes, correction(), position_, state);
  for (HeldNode& target : s.boundary.nodes) target.mend(0.5 * share * s.h * corrected_load(target.node), 2);
  result.balance.work.winches += share * of_winches;
  result.balance.dissipated.unresolved += share * of_winches;
  if (rod_.active()) result.balance.dissipated.unresolved += rod_.calm_spin(state);
}

/// The matrix at the end of the substep, of motion about it: without contacts and fluid, tension being the mean of two substeps,
/// as it alternates, too, and compression no stiffness.
void CableStepper::assemble_for_velocities() {
  for (int i = 0; i < segments_; ++i) start_density_[i] = std::max(0.0, 0.5 * (start_density_[i] + tension_density_[i]));
  assemble_segments(0.5, start_density_, segment_);
  if (bending_.active()) bending_.add_stiffness(system_);
  if (rod_.active()) rod_.assemble(segment_, start_density_);
  // A tension that is kept does not resist motion along the segment.
  if (winch_.segment >= 0 && keeps_tension(winch_.segment))
    system_.compliance[winch_.segment] = 1 / (length_rate_regularisation * inertia_[winch_.segment]);
}

/// What the held nodes' equations of motion lack is what their holders supply.
void CableStepper::react(const Substep& s, const std::vector<double>& masses) {
  for (HeldDirection& target : s.boundary.directions) target.torque.setZero();
  if (rod_.active()) rod_.finish(displacement_, segment_, s.boundary);
  if (bending_.is_damped()) with_material([&] { bending_loss_ = bending_.find_loss(displacement_); });
  if (bending_.active() && winch_node_ >= 0) {
    bending_force_.assign(segments_ + 2, 0.0);
    with_material([&] { bending_.add_segment_forces(displacement_, bending_force_); });
  }
  if (s.boundary.nodes.empty()) return;
  for (HeldNode& target : s.boundary.nodes) {
    const int i = target.node;
    const double mass = masses[i];
    target.follow(mass, get(velocity_, i), get(displacement_, i), s.h);
    // What is applied to the node goes to its holder as it is.
    const Vector3 applied = s.boundary.load_on(i);
    const Vector3 load =
        corrected_load(i) - applied + s.inertia() * mass / s.h * (get(displacement_, i) / s.h - get(velocity_, i));
    target.force = mean_force(s.scheme, load, target.lasting_force);
    if (!applied.isZero(0)) target.force += applied;
    if (!s.statics) target.force -= mass * (target.velocity - get(velocity_, i)) / s.h;
    if (!flows_.empty()) target.force += flow_reaction(s, i);
  }
  if (bending_.active()) with_material([&] { bending_.react(displacement_, s.boundary.directions); });
  if (twist_.active()) twist_.react(s.boundary);
  for (HeldDirection& target : s.boundary.directions) target.torque = mean_force(s.scheme, target.torque, target.lasting_torque);
}

/// The force of bending and twist along a segment [N].
double CableStepper::force_along(int i) const {
  const double density = tension_density_[i] - multiplier_correction()[i];  // that of the pull, before the last correction
  const Vector3 middle = get(middle_, i);
  return (get(segment_force_, i) - density * middle).dot(middle) / target_length_[i];
}

/// The load on a node after the last correction, to first order: its row of the matrix times the solution is gone.
Vector3 CableStepper::corrected_load(int i) const {
  Vector3 load = get(system_.load, i);
  for (const Flow& flow : flows_) {
    const int place = i - flow.first_node();
    if (place >= 0 && place < static_cast<int>(flow.column.size())) load += flow.correction * flow.column[place];
  }
  if (rod_.active()) {
    const VectorArray& force = rod_.elimination().force();
    if (i > 0) load -= get(force, i - 1);
    if (i < segments_) load += get(force, i);
    return load;
  }
  const VectorArray& delta = solver_.displacement();
  const std::vector<double>& multiplier = solver_.multiplier();
  if (i > 0) load -= system_.first[i - 1] * get(delta, i - 1) + multiplier[i - 1] * get(system_.direction, i - 1);
  if (i < segments_) load -= system_.first[i] * get(delta, i + 1) - multiplier[i] * get(system_.direction, i);
  if (system_.stiffened) load -= system_.added_load(i, delta);
  if (!bending_.active()) return load;
  if (i > 1) load -= system_.second[i - 2] * get(delta, i - 2);
  if (i + 1 < segments_) load -= system_.second[i] * get(delta, i + 2);
  return load;
}

/// The largest strain.
double CableStepper::store(const Substep& s, CableState& state) const {
  const double inverse_h = s.statics ? 0 : 1 / s.h;
  for (int i = 0; i <= segments_; ++i) {
    state.positions[i] = get(position_, i);
    state.velocities[i] = get(end_velocity_, i);
    state.accelerations[i] = (state.velocities[i] - get(velocity_, i)) * inverse_h;
    if (s.scheme == Scheme::damped)
      state.accelerations[i] = (get(displacement_, i) * inverse_h - get(velocity_, i)) * inverse_h + 0.5 * get(acceleration_, i);
  }
  state.yielding = 0;
  for (const OverstretchedSpan& span : overstretched_) state.yielding = std::max(state.yielding, span.share);
  const double part = s.scheme == Scheme::conserving ? 0.5 : 1;
  const bool alternates = s.treatment != Treatment::none && state.unresolved.known > 0;
  double longest = 1, shortest = 1;  // squares, relative
  for (int i = 0; i < segments_; ++i) {
    if (!flows_.empty() && lies_on_wheel(i)) {
      state.tension[i] = state.last_tension[i] = state.axial_multiplier[i] = 0;
      continue;
    }
    const bool gives = i == winch_.segment;
    const double square = get(segment_, i).squaredNorm(), rest = gives ? target_length_[i] : state.rest_lengths[i];
    const double relative = square / (rest * rest);
    longest = std::max(longest, relative);
    shortest = std::min(shortest, relative);
    const bool elastic = is_elastic_at(i);
    double length = elastic || gives ? length_[i] + part * (std::sqrt(square) - length_[i]) : target_length_[i];
    if (yields_[i] != 0) length = std::sqrt(square);
    if (!elastic && !flows_.empty() && grows(i)) length = length_[i] + part * (target_length_[i] - length_[i]);
    state.axial_multiplier[i] = tension_density_[i] * length;
    const double tension =
        bending_.active() || rod_.active() ? state.axial_multiplier[i] + force_along(i) : state.axial_multiplier[i];
    state.tension[i] = alternates ? 0.5 * (state.last_tension[i] + tension) : tension;
    state.last_tension[i] = tension;
  }
  return std::max(std::sqrt(longest) - 1, 1 - std::sqrt(shortest));
}

}  // namespace verlet_cable

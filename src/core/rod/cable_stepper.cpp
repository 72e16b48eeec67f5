#include "rod/cable_stepper.h"

#include <algorithm>
#include <cmath>

#include "chain/node_sums.h"
#include "geometry/eigen_vectors.h"
#include "law/drag.h"
#include "law/resistance.h"
#include "verlet_cable/core/cable_materials.h"

namespace verlet_cable {

namespace {

constexpr int step_iterations = 40;
/// A correction that shrinks less than this from one iteration to the next calls for a new factorisation.
constexpr double slow_convergence = 0.1;
/// Of the lengths of such spans, relative.
constexpr double greatest_gap = 1e-7;

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

/// The force of bending and twist along a segment [N].
double CableStepper::force_along(int i) const {
  const double density = tension_density_[i] - multiplier_correction()[i];  // that of the pull, before the last correction
  const Vector3 middle = get(middle_, i);
  return (get(segment_force_, i) - density * middle).dot(middle) / target_length_[i];
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

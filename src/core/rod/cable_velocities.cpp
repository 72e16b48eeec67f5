// What CableStepper does to velocities once a substep is done: lengths that do not change, momenta that are kept, and motion that
// is not resolved.
#include <algorithm>
#include <cmath>

#include "law/length_rate.h"
#include "rod/cable_stepper.h"
#include "rod/rigid_motion.h"
#include "rod/tridiagonal.h"

namespace verlet_cable {

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

}  // namespace verlet_cable

#include <algorithm>
#include <cmath>

#include "geometry/eigen_vectors.h"
#include "law/drag.h"
#include "law/resistance.h"
#include "rod/cable_stepper.h"

namespace verlet_cable {

namespace {

bool is_wound(const Boundary& boundary, int segment) {
  return std::any_of(boundary.growing.begin(), boundary.growing.end(),
                     [&](const auto& growing) { return growing.segment == segment; });
}

}  // namespace

/// [J] Of the nodes that nothing holds.
double CableStepper::kinetic_energy(const std::vector<double>& masses, const VectorArray& velocity) const {
  double energy = 0;
  for (int i = 0; i <= segments_; ++i) energy += 0.5 * system_.movable[i] * masses[i] * get(velocity, i).squaredNorm();
  return energy;
}

double CableStepper::missing_work_of_tension(double part) const {
  double work = 0;
  for (int i = 0; i < segments_; ++i) {
    if (is_elastic_at(i) || keeps_tension(i)) {
      const double growth = std::sqrt(end_square_[i]) - length_[i];
      work += system_.gap[i] / system_.compliance[i] * (length_[i] + part * growth) * growth;
    } else {
      work -= tension_density_[i] * system_.gap[i];
    }
  }
  return work;
}

double CableStepper::told_energy(const Substep& s, const CableState& state) const {
  if (s.statics) return infinity;
  double mass = 0;
  for (int i = 0; i <= segments_; ++i) mass += system_.movable[i] * state.masses[i];
  const double lifted = mass * s.environment.gravity.at(state.positions.front()).norm() * s.model.segment_length;
  return accountable_part * (kinetic_energy(state.masses, velocity_) + lifted);
}

/// What the laws take and add over the substep, which has converged and not moved yet.
void CableStepper::balance_laws(const Substep& s, const std::vector<double>& masses, double given_back,
                                SubstepResult& result) const {
  EnergyBalance& balance = result.balance;
  if (drags_) balance_drag(s, masses, balance);
  if (fluid_.active()) fluid_.add_work(displacement_, s.h, balance);
  balance.work.applied += work_of_loads(s.boundary);
  if (bending_.is_damped()) balance.dissipated.bending += bending_loss_;
  if (twist_.active()) balance.dissipated.torsional += twist_.damping_work();
  if (rod_.active()) rod_.add_losses(balance);
  balance_lengths(s, given_back, result);
  if (winch_node_ >= 0 && bending_.active()) {
    // What bends moves with the material that comes through the winch.
    const int i = std::clamp(winch_node_ - 1, 0, segments_ - 1);
    balance.work.winches += (winch_node_ == 0 ? -1 : 1) * get(bending_force_, i).dot(material_way_);
  }
  for (const Flow& flow : flows_) {
    balance.dissipated.guides += flow.resistance * flow.way;
    balance.dissipated.drag += flow.drag * flow.way * flow.way;
  }
}

/// The drag of the material, in proportion to the velocity.
void CableStepper::balance_drag(const Substep& s, const std::vector<double>& masses, EnergyBalance& balance) const {
  LinearDrag<double> drag{0, numbers_of(s.environment.fluid.velocity), 1 / s.h};
  for (int i = 0; i <= segments_; ++i) {
    if (fluid_.active()) drag.fluid = numbers_of(fluid_.flow(i));
    drag.coefficient = s.h * (inertia_[i] - s.inertia() * masses[i] / (s.h * s.h));
    const VectorOf<double> displacement = numbers_at(displacement_, i);
    balance.dissipated.drag += drag.loss(displacement);
    balance.work.applied += drag.work(displacement);
  }
}

/// [J] Of forces from outside; nodes that are held pass theirs on.
double CableStepper::work_of_loads(const Boundary& boundary) const {
  double work = 0;
  for (const NodeLoad& load : boundary.loads) work += load.force.dot(get(displacement_, load.node));
  return work;
}

/// [J] CableState::taut_energy at the end of the substep.
double CableStepper::stored_when_taut(const Substep& s) const {
  double energy = 0;
  for (int i = 0; s.boundary.nodes.size() > 1 && i < segments_; ++i)
    if (!is_elastic_at(i) && !grows(i) && !keeps_tension(i)) energy += taut_energy(strain_compliance_[i], tension_density_[i]);
  return energy;
}

bool CableStepper::changes_lengths(const Substep& s) const {
  return any_elastic_ || !s.boundary.growing.empty() || s.boundary.nodes.size() > 1;
}

/// Axial damping, and what the tension of segments that cannot stretch does where their lengths change: driven by a winch, drawn
/// out beyond what they are, or as their compliance lets them. `given_back` [J]: by how much less of that is stored.
void CableStepper::balance_lengths(const Substep& s, double given_back, SubstepResult& result) const {
  const bool is_drawn_out = result.overstretched_node >= 0 || !overstretched_.empty();
  double drawn = given_back;  // what is done and not stored
  for (int i = 0; changes_lengths(s) && i < segments_; ++i) {
    if (is_elastic_at(i)) {
      if (i == winch_.segment) result.balance.work.winches += work_of_winch_beyond();
      for (const GrowingSegment& growing : s.boundary.growing)
        if (growing.segment == i) result.balance.work.winches += work_of_winding_at_once(s, growing);
      if (axial_damping_[i] == 0) continue;
      const Straining strained = straining(s, i);
      const double middle = 0.5 * (strained.start + strained.end);
      const Resistance<double> damping{0, axial_damping_[i] / (s.h * strained.end)};
      const double force = damping.stress(0, strained.growth), lost = strained.start / middle * damping.loss(strained.growth);
      result.balance.dissipated.axial += lost;
      // A winch works against it, too: the nodes take what they move by.
      if (is_wound(s.boundary, i)) result.balance.work.winches += lost - force * (std::sqrt(end_square_[i]) - length_[i]);
      continue;
    }
    if (grows(i)) continue;
    const double work = work_of_length(tension_density_[i], get(segment_, i).squaredNorm(), end_square_[i]);
    if (rest_growth_[i] != 0 || i == winch_.segment)
      result.balance.work.winches -= work;
    else
      drawn += work;
  }
  (is_drawn_out ? result.balance.dissipated.edits : result.balance.dissipated.unresolved) += drawn;
}

/// What a winch does as velocities are mended at the end of a substep. `impulse`: with which the segment pushes its nodes apart,
/// over its length [N s/m].
void CableStepper::balance_mended_growth(const GrowingSegment& growing, double impulse, SubstepResult& result) const {
  const double work = impulse * target_length_[growing.segment] * growing.growth;
  result.balance.work.winches += work;
  result.balance.dissipated.unresolved += work;
}

}  // namespace verlet_cable

// What a cable and its holders exert on each other, in CableStepper.
#include <utility>

#include "chain/node_sums.h"
#include "chain/point_motion.h"
#include "rod/cable_stepper.h"

namespace verlet_cable {

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

}  // namespace verlet_cable

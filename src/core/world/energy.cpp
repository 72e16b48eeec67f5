#include "world/energy.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "guide/guides.h"
#include "law/resistance.h"
#include "rod/bending.h"
#include "rod/kirchhoff_rod.h"
#include "rod/substep.h"
#include "rod/twist.h"
#include "verlet_cable/core/cable_materials.h"

namespace verlet_cable {

namespace {

/// Of an energy, which is a sum over many nodes.
constexpr double relative_rounding = 64 * std::numeric_limits<double>::epsilon();

double kinetic_energy_of_nodes(const CableState& cable) {
  double sum = 0;
  for (int i = 0; i < cable.nodes(); ++i) sum += cable.masses[i] * cable.velocities[i].squaredNorm();
  return 0.5 * sum;
}

double gravity_energy_of_nodes(const CableState& cable, const GravityDesc& gravity) {
  if (gravity.type != GravityDesc::Type::uniform) {
    double sum = 0;
    for (int i = 0; i < cable.nodes(); ++i) sum += cable.masses[i] * gravity.potential_at(cable.positions[i]);
    return sum;
  }
  Vector3 moment = Vector3::Zero();
  for (int i = 0; i < cable.nodes(); ++i) moment += cable.masses[i] * cable.positions[i];
  return -gravity.acceleration.dot(moment);
}

double stretching_energy(const State& state, int index) {
  const SimulatedCable& cable = state.cables[index];
  const CableMaterials materials(cable);
  const bool varies = materials.vary(), guided = !state.guides.empty();
  double stiffness = cable.model->material.axial_stiffness, energy = 0;
  for (int i = 0; i < cable.state.segments(); ++i) {
    if (varies) stiffness = materials[i].axial_stiffness;
    if (stiffness == infinity || (guided && lies_on_wheel(state, index, i))) continue;
    const double e = strain(cable.state, i);
    energy += Resistance<double>{stiffness * cable.state.rest_lengths[i], 0}.energy(e);
  }
  return energy;
}

/// [m] The longest segment, or where there are no cables the longest radius of gyration.
double length_of_part(const Island& island, const State& state) {
  double length = 0;
  for (const int cable : island.cables) length = std::max(length, state.cables[cable].model->segment_length);
  if (!island.cables.empty()) return length;
  for (const int body : island.bodies)
    length = std::max(length, std::sqrt(state.bodies[body].inertia.trace() / state.bodies[body].mass));
  return length;
}

}  // namespace

Energy energy_of_cable(const State& state, int index) {
  std::vector<HeldDirection> directions;
  return energy_of_cable(state, index, 0, directions);
}

Energy energy_of_cable(const State& state, int index, double part, std::vector<HeldDirection>& directions) {
  const SimulatedCable& cable = state.cables[index];
  const CableState& c = cable.state;
  const GravityDesc& gravity = state.scene->gravity;
  const CableMaterials materials(cable);
  Energy energy;
  const KinematicTargets& targets = state.cable_progress[index].targets;
  hold_directions_at(part, part, targets, directions);
  hold_directions_on_bodies(state.attachments, state.bodies, targets, directions);
  std::vector<int> shaped;
  for (const Attachment& attachment : state.attachments) {
    if (attachment.guide < 0 || attachment.body != cable_id(index)) continue;
    const SimulatedGuide& guide = state.guides[attachment.guide];
    energy.bend += guide.held_energy * held_part(guide.held_way / cable.model->segment_length);
    energy.stretch += guide.wheel_energy;
    if (is_wheel(attachment)) shaped.insert(shaped.end(), {attachment.node, attachment.node + 1});
  }
  if (c.directors.empty()) {
    const std::optional<LengthDrive>& drive = state.cable_progress[index].drive;
    energy.bend += bending_energy(*cable.model, c, directions, shaped, drive ? drive->segment : -1);
  } else {
    const RodEnergy rod = rod_energy(*cable.model, c, directions, shaped);
    energy.bend += rod.bend;
    energy.twist = rod.twist;
    energy.kinetic = rod.spin;
  }
  energy.kinetic += kinetic_energy_of_nodes(c);
  energy.gravity = gravity_energy_of_nodes(c, gravity);
  const bool is_twisted = c.directors.empty() && !state.cable_progress[index].spans.empty();
  for (int i = 0; is_twisted && i < c.segments(); ++i)
    energy.twist += Resistance<double>{torsional_stiffness_at(materials, i) * c.rest_lengths[i], 0}.energy(c.twist[i]);
  energy.stretch += c.taut_energy;
  if (materials.any_elastic()) energy.stretch += stretching_energy(state, index);
  if (!state.guides.empty()) energy.kinetic += flow_energy(state, index);
  return energy;
}

Energy energy_of_body(const State& state, int index) {
  const SimulatedBody& body = state.bodies[index];
  const Vector3 spin = body.pose.orientation.conjugate() * body.angular_velocity;
  Energy energy;
  energy.kinetic = 0.5 * body.mass * body.velocity.squaredNorm() + 0.5 * spin.dot(body.inertia * spin);
  if (body.fluid.added_mass.maxCoeff() > 0) {
    const Vector3 moving =
        body.pose.orientation.conjugate() * body.velocity + spin.cross(body.fluid.center - body.center_of_mass);
    energy.kinetic += 0.5 * moving.dot(body.fluid.added_mass.cwiseProduct(moving));
  }
  energy.gravity = body.mass * state.scene->gravity.potential_at((body.pose * Pose{body.center_of_mass}).position);
  return energy;
}

namespace {

/// [J] What is rounded where energies of an island are taken from each other.
double rounding_of_energy(const Island& island, const State& state) {
  double size = 0;
  for (const int cable : island.cables) size += std::abs(state.cable_progress[cable].energy);
  for (const int body : island.bodies) size += std::abs(state.body_progress[body].energy);
  return relative_rounding * size;
}

}  // namespace

double energy_of(const Island& island, const State& state, double part, std::vector<HeldDirection>& directions) {
  double sum = 0;
  for (const int cable : island.cables) sum += energy_of_cable(state, cable, part, directions).total();
  for (const int body : island.bodies) sum += energy_of_body(state, body).total();
  return sum;
}

double kinetic_energy_of(const Island& island, const State& state) {
  double sum = 0;
  for (const int cable : island.cables) sum += kinetic_energy_of_nodes(state.cables[cable].state);
  for (const int body : island.bodies) sum += energy_of_body(state, body).kinetic;
  return sum;
}

double follow_energy_of_cable(int cable, State& state) {
  std::vector<HeldDirection> directions;
  return follow_energy_of_cable(cable, state, directions);
}

double follow_energy_of_cable(int cable, State& state, std::vector<HeldDirection>& directions) {
  double& known = state.cable_progress[cable].energy;
  const double before = known;
  known = energy_of_cable(state, cable, 0, directions).total();
  return known - before;
}

double follow_energy_of_body(int body, State& state) {
  double& known = state.body_progress[body].energy;
  const double before = known;
  known = energy_of_body(state, body).total();
  return known - before;
}

bool is_accounted(double unaccounted, const Island& island, const State& state, const EnergyBalance& balance) {
  const EnergyBalance::Work& work = balance.work;
  const double size = std::abs(unaccounted) / accountable_part;
  double energy = std::abs(work.attachments) + std::abs(work.winches) + std::abs(work.obstacles) + std::abs(work.applied);
  if (size <= energy) return true;
  energy += kinetic_energy_of(island, state);
  if (size <= energy) return true;
  const Vector3 place = island.cables.empty() ? state.bodies[island.bodies.front()].pose.position
                                              : state.cables[island.cables.front()].state.positions.front();
  // Velocities within the tolerance are none: where nothing weighs anything, what they make is rounding.
  const double length = length_of_part(island, state), slow = state.scene->tolerance * length;
  energy += mass_of(island, state) * (state.scene->gravity.at(place).norm() * length + slow * slow);
  return size <= energy + rounding_of_energy(island, state) / accountable_part;
}

void account_for_displacement(double change, EnergyBalance& balance) {
  (change < 0 ? balance.dissipated.edits : balance.work.attachments) += std::abs(change);
}

void account_for_unfollowed(double change, EnergyBalance& balance) {
  (change < 0 ? balance.dissipated.unresolved : balance.work.attachments) += std::abs(change);
}

void account_for_edit(double change, EnergyBalance& balance) {
  (change < 0 ? balance.dissipated.edits : balance.work.applied) += std::abs(change);
}

}  // namespace verlet_cable

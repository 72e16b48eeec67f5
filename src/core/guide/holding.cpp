#include <algorithm>
#include <cmath>

#include "chain/direction.h"
#include "guide/given_node.h"
#include "guide/guides.h"
#include "guide/node_passing.h"
#include "guide/wheel.h"
#include "target/length_drive.h"
#include "verlet_cable/core/cable_materials.h"
#include "world/energy.h"
#include "world/implementation.h"
#include "world/island_stepper.h"
#include "world/loads.h"

namespace verlet_cable {

namespace {

/// Having let its cable go a clip takes it again after it was so far away, in capture distances.
constexpr double ready_distance = 2;
/// Of a segment: nearer than this to a node no other one is made for a clip that takes the cable.
constexpr double merging_distance = 0.2;

/// The cable's direction at a guide.
Vector3 direction_at(const CableState& cable, int first, int last) {
  return (segment_direction(cable, first - 1) + segment_direction(cable, last)).normalized();
}

/// [J] The weight of the nodes beside a wheel and on it.
double weight_at_wheel(const CableState& cable, int first, const GravityDesc& gravity) {
  double energy = 0;
  for (int node = first - 1; node <= first + 2; ++node)
    energy += cable.masses[node] * gravity.potential_at(cable.positions[node]);
  return energy;
}

/// A node takes over material [kg] that has come off a wheel, or gives up some that has come onto it: that is as fast as the node
/// along the cable, but does not move with it across. Nothing pulls there, so that the node keeps its energy.
void take_from_wheel(double gained, const Vector3& wheel_velocity, const Vector3& along, int node, CableState& cable) {
  const double mass = cable.masses[node];
  const Vector3 velocity = cable.velocities[node] - wheel_velocity, across = velocity - velocity.dot(along) * along;
  cable.velocities[node] += (std::sqrt(mass / (mass + gained)) - 1) * across;
  cable.masses[node] += gained;
}

/// Where a wheel touches its cable now. What was straight is on the wheel then, or the other way round, with its strain. No force
/// moves along the cable with that: what the nodes have more in energy their material on the wheel has less.
void follow_on_wheel(int index, State& state, Attachment& attachment) {
  SimulatedGuide& guide = state.guides[attachment.guide];
  SimulatedCable& cable = state.cables[index];
  CableState& c = cable.state;
  const int first = attachment.node, last = first + 1;
  const Pose wheel = state.frames.previous_poses[attachment.frame] * attachment.pose;
  Attachment next = attachment;
  for (const int side : {0, 1})
    next.tangent_points[side] = tangent_point(wheel, guide, side, c.positions[side == 0 ? first - 1 : last + 1],
                                              wheel.position + wheel.orientation * attachment.tangent_points[side]);
  // A cable that has left the wheel is held by it all the same.
  if (std::abs(arc_on_wheel(guide, next) - arc_on_wheel(guide, attachment)) > M_PI * guide.radius) return;
  const double half_density = 0.5 * CableMaterials(cable)[first].linear_density;
  guide.wheel_energy += weight_at_wheel(c, first, state.scene->gravity);
  for (const int side : {0, 1}) {
    const int node = side == 0 ? first : last, segment = side == 0 ? first - 1 : last, beside = side == 0 ? first - 1 : last + 1;
    const Vector3 place = wheel.position + wheel.orientation * next.tangent_points[side];
    const double before = (c.positions[node] - c.positions[beside]).norm(), after = (place - c.positions[beside]).norm();
    const double growth = c.rest_lengths[segment] * (after / before - 1);
    if (c.rest_lengths[first] - growth <= 0) break;
    const double stretch = strain(c, segment), stiffness = CableMaterials(cable)[segment].axial_stiffness;
    if (stiffness < infinity) guide.wheel_energy -= 0.5 * stiffness * stretch * stretch * growth;
    attachment.tangent_points[side] = next.tangent_points[side];
    c.positions[node] = place;
    c.rest_lengths[segment] += growth;
    c.rest_lengths[first] -= growth;
    take_from_wheel(half_density * growth, c.velocities[node], (c.positions[beside] - place).normalized(), beside, c);
    c.masses[side == 0 ? last : first] -= half_density * growth;
    for (KinematicTarget& target : state.cable_progress[index].targets.nodes)
      if (target.node == node) target.position = place;
  }
  guide.wheel_energy -= weight_at_wheel(c, first, state.scene->gravity);
}

}  // namespace

/// Cables that slide through guides are numbered anew; clips take them and let them go.
void World::Implementation::advance_guides() {
  if (state.guides.empty()) return;
  for (int a = static_cast<int>(state.attachments.size()) - 1; a >= 0; --a) {
    if (state.attachments[a].guide < 0 || !lets_go(a)) continue;
    const int cable = state.attachments[a].body.index;
    release_guide(a);
    account_for_blow(cable);
  }
  for (int guide = 0; guide < static_cast<int>(state.guides.size()); ++guide)
    if (state.guides[guide].capture > 0) capture_cable(guide);
  for (std::size_t i = 0; i < state.cables.size(); ++i) {
    if (!slides(state.cable_progress[i].targets)) continue;
    for (Attachment& attachment : state.attachments)
      if (attachment.body == cable_id(static_cast<int>(i)) && is_wheel(attachment))
        follow_on_wheel(static_cast<int>(i), state, attachment);
    keep_flow_at_drive(static_cast<int>(i), 0, state);  // the step is planned already
    pass_nodes_of(static_cast<int>(i));
  }
}

/// Whether a free end runs out of a guide, or a clip is drawn off the cable.
bool World::Implementation::lets_go(int index) const {
  const Attachment& attachment = state.attachments[index];
  const SimulatedGuide& guide = state.guides[attachment.guide];
  if (runs_out(attachment, state)) return true;
  if (!(guide.retention < infinity)) return false;
  const Vector3 along = direction_at(state.cables[attachment.body.index].state, attachment.node, last_node(attachment));
  return (attachment.force - attachment.force.dot(along) * along).norm() > guide.retention;
}

/// The material goes on with the velocity that it has.
void World::Implementation::release_guide(int index) {
  const Attachment attachment = state.attachments[index];
  SimulatedGuide& guide = state.guides[attachment.guide];
  CableState& cable = state.cables[attachment.body.index].state;
  for (int node = attachment.node; node <= last_node(attachment); ++node)
    cable.velocities[node] += guide.flow * way_past(cable, node).normalized();
  stop_flow(guide);
  guide.lost_length = guide.wheel_energy = 0;
  guide.is_ready = false;
  erase_attachment(index);
  after_remeshing(attachment.body.index);
  findings.released.push_back(attachment.guide);
}

/// Those that a segment lies on which is to be cut: neither piece has both of its nodes.
void World::Implementation::release_wheels_on(int cable, int segment) {
  for (int a = static_cast<int>(state.attachments.size()) - 1; a >= 0; --a) {
    const Attachment& attachment = state.attachments[a];
    if (attachment.body == cable_id(cable) && attachment.node == segment && is_wheel(attachment)) release_guide(a);
  }
}

/// Guides that have no cable on one side after a cut.
void World::Implementation::release_bare_guides() {
  for (int a = static_cast<int>(state.attachments.size()) - 1; a >= 0; --a) {
    const Attachment& attachment = state.attachments[a];
    if (attachment.guide < 0) continue;
    if (attachment.node <= 0 || last_node(attachment) >= state.cables[attachment.body.index].state.segments()) release_guide(a);
  }
}

/// What is done to a cable at once is lost, or work of what does it.
void World::Implementation::account_for_blow(int cable) {
  const double change = follow_energy_of_cable(cable, state);
  CableOutcome& outcome = cable_outcomes.value[cable];
  outcome.change += change;
  account_for_unfollowed(change, outcome.balance);
}

/// An open clip takes its cable where that comes close.
void World::Implementation::capture_cable(int index) {
  SimulatedGuide& guide = state.guides[index];
  const auto holds = [&](const Attachment& a) { return a.guide == index; };
  if (std::any_of(state.attachments.begin(), state.attachments.end(), holds)) return;
  const int cable_index = find(state.cables, guide.cable);
  if (cable_index < 0 || !state.frames.known[guide.frame]) return;
  SimulatedCable& cable = state.cables[cable_index];
  const Vector3 place = (state.frames.poses[guide.frame] * guide.pose).position;
  const NearestPoint nearest = nearest_point(cable.state, place);
  guide.is_ready = guide.is_ready || nearest.distance > ready_distance * guide.capture;
  if (!guide.is_ready || !(nearest.distance <= guide.capture)) return;
  int node = nearest.fraction < 0.5 ? nearest.segment : nearest.segment + 1;
  const double to_node = std::abs(nearest.fraction - (node - nearest.segment)) * cable.state.rest_lengths[nearest.segment];
  if (node == 0 || node == cable.state.segments() || state.cable_progress[cable_index].drive) return;
  const double energy = energy_of_cable(state, cable_index).potential();
  if (to_node > merging_distance * cable.model->segment_length) {
    node = nearest.segment + 1;
    insert_node(nearest.segment, nearest.fraction * cable.state.rest_lengths[nearest.segment], *cable.model, cable.state);
    renumber(cable_index, node, 1);
  } else if (!is_passable(state, cable_index, node)) {
    return;
  }
  Attachment attachment = hold_by(guide, index, cable_index, state.body_of_frame(guide.frame));
  attachment.node = node;
  stop_flow(guide);
  guide.flow = cable.state.velocities[node].dot(direction_at(cable.state, node, node));
  cable.state.velocities[node] -= guide.flow * direction_at(cable.state, node, node);
  state.attachments.push_back(attachment);
  take_off(cable_index, node, state);
  put_on(cable_index, node + 1, state);
  after_remeshing(cable_index);
  move_with_holders(cable_index, state);
  yield_to_given_nodes(cable_index, state);
  // As of a node that passes; but what it does to the motion is a blow.
  guide.held_energy = energy - energy_of_cable(state, cable_index).potential();
  account_for_blow(cable_index);
  findings.caught.push_back(index);
}

}  // namespace verlet_cable

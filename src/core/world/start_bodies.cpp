#include <algorithm>
#include <cmath>
#include <numeric>

#include "rod/rod_frames.h"
#include "verlet_cable/core/cable_materials.h"
#include "world/energy.h"
#include "world/implementation.h"
#include "world/junctions.h"

namespace verlet_cable {

namespace {

/// The body's pose that puts its attachment at where that is held; one that holds a point alone keeps the orientation.
Pose held_pose(const SimulatedBody& body, const Attachment& attachment, const Pose& holder) {
  const Pose wanted = holder * attachment.pose;
  if (attachment.type != AttachmentType::hinge) return wanted * attachment.at.inverse();
  Pose pose = body.pose;
  pose.position += wanted.position - (body.pose * attachment.at).position;
  return pose;
}

/// Turns a body by the least that brings its axle's direction to the holder's, and moves it there.
Pose on_axle(const SimulatedBody& body, const Attachment& attachment, const Pose& holder) {
  const Quaternion own = body.pose.orientation * attachment.at.orientation;
  const Quaternion wanted = holder.orientation * attachment.pose.orientation;
  SimulatedBody turned = body;
  turned.pose.orientation = (Quaternion::FromTwoVectors(own * Vector3::UnitZ(), wanted * Vector3::UnitZ()) * own *
                             attachment.at.orientation.conjugate())
                                .normalized();
  Attachment point = attachment;
  point.type = AttachmentType::hinge;
  return held_pose(turned, point, holder);
}

}  // namespace

/// Bodies whose holders are known begin where those hold them; one that nothing but cables hold, without a pose of its own, waits
/// for the first of them.
void World::Implementation::place_bodies() {
  const auto count_placed = [&] {
    return std::count_if(state.body_progress.begin(), state.body_progress.end(),
                         [](const BodyProgress& body) { return body.is_placed; });
  };
  const auto before = count_placed();
  bool more = true;
  while (more) {
    more = false;
    for (int b = 0; b < static_cast<int>(state.bodies.size()); ++b) {
      if (state.body_progress[b].is_placed || state.bodies[b].is_junction || !place_body(b)) continue;
      more = true;
    }
  }
  if (count_placed() != before) name_waiting();
}

bool World::Implementation::place_body(int index) {
  SimulatedBody& body = state.bodies[index];
  const BodyDesc& desc = state.scene->bodies[index];
  const Attachment* first = nullptr;
  for (const Attachment& attachment : state.attachments) {
    if (attachment.body != rigid_body_id(index)) continue;
    if (!state.frames.known[attachment.frame]) return false;
    const bool orients = attachment.type != AttachmentType::hinge;
    if (!first || (orients && first->type == AttachmentType::hinge)) first = &attachment;
  }
  if (first) {
    const Pose& holder = state.frames.poses[first->frame];
    body.pose =
        desc.pose && first->type == AttachmentType::axle ? on_axle(body, *first, holder) : held_pose(body, *first, holder);
  } else if (waits_for_cable(index) || (!desc.pose && is_held_by_cable(index))) {
    return false;
  }
  note_placed(index);
  return true;
}

void World::Implementation::note_placed(int index) {
  const SimulatedBody& body = state.bodies[index];
  state.body_progress[index].is_placed = true;
  state.initial_energy += follow_energy_of_body(index, state);
  state.frames.known[body.frame] = true;
  state.frames.poses[body.frame] = state.frames.previous_poses[body.frame] = body.pose;
}

/// Whether it hangs on a cable that has not started yet.
bool World::Implementation::waits_for_cable(int index) const {
  return std::any_of(state.waiting_cables.begin(), state.waiting_cables.end(),
                     [&](int i) { return hangs_on(*state.scene, state.scene->bodies[index], state.scene->cables[i]); });
}

bool World::Implementation::is_held_by_cable(int index) const {
  const std::string& name = state.bodies[index].name;
  return std::any_of(state.scene->cables.begin(), state.scene->cables.end(), [&](const CableDesc& cable) {
    return std::any_of(cable.attachments.begin(), cable.attachments.end(),
                       [&](const AttachmentDesc& attachment) { return attachment.body == name; });
  });
}

/// Whether the bodies that hold a cable are where they begin, or begin where it ends.
bool World::Implementation::has_bodies_of(const CableDesc& cable) const {
  for (const GuideDesc& guide : state.scene->guides)
    if (guide.cable == cable.name && guide.place && !guide.body.empty()) {
      const int body = find(state.bodies, guide.body);
      const BodyDesc& desc = state.scene->bodies[body];
      if (!state.body_progress[body].is_placed && !(desc.pose && desc.attachments.empty())) return false;
    }
  return std::all_of(cable.attachments.begin(), cable.attachments.end(), [&](const AttachmentDesc& attachment) {
    if (attachment.body.empty()) return true;
    const int body = find(state.bodies, attachment.body);
    return state.body_progress[body].is_placed || state.scene->bodies[body].attachments.empty();
  });
}

/// [m/s^2] By which a cable hangs that begins at `place`: upwards, where the bodies that begin at it lift it through the fluid.
Vector3 World::Implementation::hanging_gravity(const SimulatedCable& cable, const std::vector<Attachment>& placing,
                                               const Vector3& place) const {
  const FluidDesc& fluid = state.scene->fluid;
  const Vector3 gravity = state.scene->gravity.at(place);
  if (!(place.z() < fluid.surface)) return gravity;
  double lift = 0;  // [kg]
  for (auto a = placing.begin(); a != placing.end(); ++a) {
    const SimulatedBody& body = state.bodies[a->holder];
    const bool is_counted = std::any_of(placing.begin(), a, [&](const Attachment& other) { return other.holder == a->holder; });
    if (!is_counted) lift += fluid.density * body.fluid.volume - body.mass;
  }
  const CableMaterials materials(cable);
  double weight = std::accumulate(cable.state.masses.begin(), cable.state.masses.end(), 0.0);
  for (int i = 0; i < cable.state.segments(); ++i)
    weight -= fluid.density * M_PI * materials[i].radius * materials[i].radius * cable.state.rest_lengths[i];
  return lift > std::max(0.0, weight) ? Vector3(-gravity) : gravity;
}

/// Bodies that a cable that has just started places: where it is clamped to them, else with their own axes.
void World::Implementation::place_bodies_on(const std::vector<Attachment>& attachments) {
  for (const Attachment& attachment : attachments) {
    SimulatedBody& body = state.bodies[attachment.holder];
    const CableState& cable = state.cables[attachment.body.index].state;
    if (!state.body_progress[attachment.holder].is_placed) {
      const Vector3& place = cable.positions[attachment.node];
      if (body.is_junction) {
        body.velocity = cable.velocities[attachment.node];
        body.angular_velocity = spin_at(cable, attachment.node);
      }
      if (attachment.type == AttachmentType::clamp || body.is_junction)
        body.pose = Pose{place, axes_at(cable, attachment.node)} * attachment.pose.inverse();
      else
        body.pose.position = place - body.pose.orientation * attachment.pose.position;
      note_placed(attachment.holder);
    }
    state.attachments.push_back(attachment);
  }
  if (attachments.empty()) return;
  const int index = attachments.front().body.index;
  find_targets_of(index);
  // A cable that is joined with itself closes at once, as cables that are joined with others do.
  for (KinematicTarget& target : state.cable_progress[index].targets.nodes) {
    if (!state.attachments[target.attachment].is_junction) continue;
    target.gap.setZero();
    target.caught = -infinity;
  }
}

/// The nodes that bodies hold begin to move with them.
void World::Implementation::start_with_bodies(const CableState& cable, KinematicTargets& targets) const {
  Boundary boundary;
  hold_at(1, 1, targets, boundary);
  hold_on_bodies(cable, state.attachments, state.bodies, state.time(), targets, boundary);
  for (std::size_t k = 0; k < boundary.nodes.size(); ++k) {
    if (boundary.nodes[k].body < 0) continue;
    KinematicTarget& target = targets.nodes[k];
    target.velocity = target.mean_velocity = target.next_velocity = boundary.nodes[k].velocity;
  }
}

}  // namespace verlet_cable

#include "verlet_cable/core/world.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "initial_shape.h"
#include "length_projection.h"
#include "rest_curvature.h"
#include "stiff_ends.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/rotation.h"
#include "verlet_cable/core/scene_fields.h"
#include "world_implementation.h"

namespace verlet_cable {

namespace {

CableModel make_model(const SceneDesc& scene, const CableDesc& desc) {
  CableModel model;
  model.name = desc.name;
  model.material = *scene.find_material(desc.material);
  model.material_name = desc.material;
  model.color = desc.color;
  const double length = desc.length / desc.segments;
  model.segment_length = length;
  model.rest_lengths.assign(desc.segments, length);
  model.masses.assign(desc.segments + 1, 0.0);
  for (int i = 0; i < desc.segments; ++i) {
    model.masses[i] += 0.5 * length * model.material.linear_density;
    model.masses[i + 1] += 0.5 * length * model.material.linear_density;
  }
  for (const PointMassDesc& point : desc.point_masses) model.masses[node_at(desc, point.place)] += point.mass;
  return model;
}

}  // namespace

bool is_sound(const Pose& pose) {
  const double length = pose.orientation.norm();
  return (pose.position.cwiseAbs().array() <= coordinate.highest).all() && length >= 0.5 && length <= 2;
}

std::string pose_problem(const std::string& field, const Pose& pose) {
  for (int axis = 0; axis < 3; ++axis)
    if (!coordinate.contains(pose.position[axis]))
      return field + ".position." + "xyz"[axis] + ": " + number_text(pose.position[axis]) + "; allowed: " + coordinate.text("m");
  if (is_sound(pose)) return "";
  return field + ".orientation: of length " + number_text(pose.orientation.norm()) +
         "; allowed: 1 (from 0.5 to 2 is brought to 1)";
}

int find_frame(const std::vector<std::string>& frames, const std::string& name) {
  return static_cast<int>(std::find(frames.begin(), frames.end(), name) - frames.begin());
}

void note_status(StepResult::Status status, int cable, int node, StepResult& result) {
  if (status <= result.status) return;
  result.status = status;
  result.cable = cable;
  result.node = node;
}

void bring_to_rest(CableState& state) {
  std::fill(state.velocities.begin(), state.velocities.end(), Vector3::Zero());
  std::fill(state.accelerations.begin(), state.accelerations.end(), Vector3::Zero());
}

World::World(const SceneDesc& scene, const BoundaryInputs& inputs, const std::atomic<bool>* cancelled) : World(scene) {
  implementation_->cancelled = cancelled;
  implementation_->follow_frames(inputs);
  start_waiting(inputs);
  implementation_->cancelled = nullptr;
}

World::World(const SceneDesc& scene) : implementation_(std::make_unique<Implementation>()) {
  std::vector<std::string> errors = validate(scene);
  if (!errors.empty()) throw SceneError(std::move(errors));
  Implementation& w = *implementation_;
  w.scene = scene;
  w.frames = frame_names(scene);
  w.poses.resize(w.frames.size());
  w.previous_poses.resize(w.frames.size());
  w.known.assign(w.frames.size(), false);
  w.known.front() = true;
  w.add_scene_obstacles();
  for (int i = 0; i < static_cast<int>(scene.cables.size()); ++i) {
    w.waiting_descs.push_back(i);
    w.waiting.push_back(scene.cables[i].name);
  }
  for (int i = 0; i < static_cast<int>(scene.nets.size()); ++i) {
    w.waiting_nets.push_back(i);
    w.waiting.push_back(scene.nets[i].name);
  }
  for (const ParticleDesc& particle : scene.particles) w.add_particle(particle);
  w.follow_frames({});
}

World::~World() = default;
World::World(const World& other) : implementation_(std::make_unique<Implementation>(*other.implementation_)) {}
World& World::operator=(const World& other) {
  *implementation_ = *other.implementation_;
  return *this;
}
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

int World::start_waiting(const BoundaryInputs& inputs) {
  Implementation& w = *implementation_;
  int started = 0;
  const auto start_known = [&](std::vector<int>& waiting, const auto& descs, const auto& start) {
    std::vector<int> unknown;
    for (const int index : waiting) {
      if (w.is_cancelled() || !w.frames_known(descs[index], inputs)) {
        unknown.push_back(index);
        continue;
      }
      w.follow_frames(inputs);
      start(descs[index]);
      ++started;
    }
    waiting = std::move(unknown);
  };
  start_known(w.waiting_descs, w.scene.cables, [&](const CableDesc& desc) { w.start_cable(desc, inputs); });
  if (started > 0) w.form_groups();
  start_known(w.waiting_nets, w.scene.nets, [&](const NetDesc& desc) { w.start_net(desc, inputs); });
  w.waiting.clear();
  for (const int index : w.waiting_descs) w.waiting.push_back(w.scene.cables[index].name);
  for (const int index : w.waiting_nets) w.waiting.push_back(w.scene.nets[index].name);
  return started;
}

template <class Desc>
bool World::Implementation::frames_known(const Desc& desc, const BoundaryInputs& inputs) const {
  return std::all_of(desc.attachments.begin(), desc.attachments.end(), [&](const auto& attachment) {
    const int frame = attachment.frame.empty() ? 0 : find_frame(frames, attachment.frame);
    return frame == 0 || (frame < static_cast<int>(inputs.size()) && inputs[frame].known && is_sound(inputs[frame].pose));
  });
}

/// A frame that is unknown, or whose pose is not sound, stays where it was; the first of the latter is returned, else -1. The
/// fixed frame does not move.
int World::Implementation::follow_frames(const BoundaryInputs& inputs) {
  int ignored = -1;
  previous_poses = poses;
  for (std::size_t i = 1; i < std::min(poses.size(), inputs.size()); ++i) {
    if (!inputs[i].known) continue;
    if (!is_sound(inputs[i].pose)) {
      if (ignored < 0) ignored = static_cast<int>(i);
      continue;
    }
    poses[i] = {inputs[i].pose.position, inputs[i].pose.orientation.normalized()};
    if (!known[i]) previous_poses[i] = poses[i];
    known[i] = true;
  }
  for (Obstacle& obstacle : obstacles) obstacle.present = known[obstacle.frame];
  return ignored;
}

void World::Implementation::start_cable(const CableDesc& desc, const BoundaryInputs& inputs) {
  const int index = static_cast<int>(cables.size());
  SimulatedCable cable;
  cable.model = make_model(scene, desc);
  for (const AttachmentDesc& a : desc.attachments) {
    Attachment attachment;
    attachment.name = a.name;
    attachment.cable = index;
    attachment.node = node_at(desc, a.place);
    attachment.frame = a.frame.empty() ? 0 : find_frame(frames, a.frame);
    attachment.type = a.type;
    attachment.pose = {a.offset, quaternion_from_rpy(a.rotation)};
    attachments.push_back(attachment);
  }
  // The holders catch the nodes where they want them: there is no gap to close.
  cable.state.positions.assign(cable.model.nodes(), Vector3::Zero());
  cable.state.velocities.assign(cable.model.nodes(), Vector3::Zero());
  CableScratch s;
  s.holders = find_holders(index, cable.model, cable.state, attachments, poses, {}, time());
  for (Holder& holder : s.holders.nodes) {
    holder.gap.setZero();
    holder.caught = -infinity;
  }
  for (DirectionHolder& holder : s.holders.directions) holder.gap.setIdentity();
  aim_holders(cable.model, attachments, poses, time(), s.holders);
  put_at_aim(s.holders);
  start_holders(attachments, poses, inputs, s.holders);
  hold_at(1, 1, s.holders, s.boundary);
  const Vector3 gravity =
      scene.gravity.at(s.boundary.nodes.empty() ? Vector3(Vector3::Zero()) : s.boundary.nodes.front().position);
  const bool settles = settles_at_start(desc, cable.model.material);
  if (!set_initial_state(desc.initial, settles, cable.model, s.boundary.nodes, gravity, cable.state))
    misfits.push_back(desc.name);
  // Where velocities of holders are not known yet, the first step finds them, and all go together.
  const auto starts = [](const Holder& holder) { return holder.starts; };
  if (std::none_of(s.holders.nodes.begin(), s.holders.nodes.end(), starts))
    project_velocities(cable.model, s.boundary.nodes, cable.state.positions, cable.state.velocities);
  cable.state.twist.assign(cable.model.segments(), 0.0);
  cable.state.reference_orientation = smallest_rotation(Vector3::UnitX(), cable.state.positions[1] - cable.state.positions[0]);
  s.spans = find_spans(cable.model, cable.state, s.boundary.directions);
  cables.push_back(std::move(cable));
  scratch.push_back(std::move(s));
  follow_material(index);
  set_stiff_ends(desc.stiff_ends, cables.back().model);
  set_rest_curvature(desc.rest_curvature, scratch.back().holders.directions, cables.back());
  scratch.back().stepper.resize(cables.back().model);
  if (settles) settle_start(index);
}

/// The segment of a cable that breaks now, -1 if it holds. A piece keeps at least one segment, so that the outermost ones do not
/// break.
int World::Implementation::breaking_segment(int index, const StepResult& result) const {
  const SimulatedCable& cable = cables[index];
  const double limit = cable.model.material.breaking_tension;
  const std::vector<double>& tension = cable.state.tension;
  if (!(limit < infinity) || tension.size() < 3) return -1;
  const auto tightest = std::max_element(tension.begin() + 1, tension.end() - 1);
  // What cannot stretch and is pulled beyond its length breaks at any strength.
  const bool torn = result.status == StepResult::Status::overstretched && cable.model.material.axial_stiffness == infinity;
  const bool exceeded = *std::max_element(tension.begin(), tension.end()) > limit;
  return torn || exceeded ? static_cast<int>(tightest - tension.begin()) : -1;
}

void World::Implementation::add_forces(int cable, double weight) {
  const CableScratch& s = scratch[cable];
  for (std::size_t k = 0; k < s.boundary.nodes.size(); ++k) {
    Attachment& attachment = attachments[s.holders.nodes[k].attachment];
    const Vector3 force = weight * s.boundary.nodes[k].force;
    const Vector3 arm = s.boundary.nodes[k].position - (poses[attachment.frame] * attachment.pose).position;
    attachment.force += force;
    if (s.holders.nodes[k].node != attachment.node) attachment.torque += arm.cross(force);
  }
  for (std::size_t k = 0; k < s.boundary.directions.size(); ++k)
    attachments[s.holders.directions[k].attachment].torque += weight * s.boundary.directions[k].torque;
}

void World::Implementation::update_holders(int index) {
  SimulatedCable& cable = cables[index];
  CableScratch& s = scratch[index];
  s.holders = find_holders(index, cable.model, cable.state, attachments, poses, s.holders, time());
  aim_holders(cable.model, attachments, poses, time(), s.holders);
  hold_at(0, 0, s.holders, s.boundary);
  restore_lengths(cable.model, s.boundary.nodes, gravity_near(index), cable.state);
  s.spans = find_spans(cable.model, cable.state, s.boundary.directions);
}

/// Where a cable hangs to: gravity at its first node.
Vector3 World::Implementation::gravity_near(int cable) const {
  return scene.gravity.at(cables[cable].state.positions.front());
}

/// Twist and roll of the material after a step: from the clamps where there are any, else the first segment's is carried along in
/// time.
void World::Implementation::follow_material(int index) {
  CableState& state = cables[index].state;
  const CableScratch& s = scratch[index];
  if (s.boundary.directions.empty()) {
    const Vector3 before = state.reference_orientation * Vector3::UnitX(), now = state.positions[1] - state.positions[0];
    state.reference_node = 0;
    state.reference_orientation = (smallest_rotation(before, now) * state.reference_orientation).normalized();
  } else {
    state.reference_node = s.boundary.directions.front().node;
    state.reference_orientation = s.boundary.directions.front().end;
  }
  std::fill(state.twist.begin(), state.twist.end(), 0.0);
  for (const TwistSpan& span : s.spans) {
    const double length = cables[index].model.length(span.first_node, span.last_node);
    std::fill(state.twist.begin() + span.first_node, state.twist.begin() + span.last_node, span.angle / length);
  }
}

}  // namespace verlet_cable

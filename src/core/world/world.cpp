#include "verlet_cable/core/world.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <utility>

#include "body/make_body.h"
#include "guide/guides.h"
#include "guide/node_passing.h"
#include "rod/bending_memory.h"
#include "rod/initial_shape.h"
#include "rod/kirchhoff_rod.h"
#include "rod/length_projection.h"
#include "rod/rest_curvature.h"
#include "rod/rod_frames.h"
#include "rod/stiff_ends.h"
#include "scene/coupled_places.h"
#include "scene/validate_guides.h"
#include "verlet_cable/core/cable_materials.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/rotation.h"
#include "verlet_cable/core/scene_fields.h"
#include "world/body_settling.h"
#include "world/holding_bodies.h"
#include "world/implementation.h"
#include "world/invariant.h"
#include "world/island_stepper.h"
#include "world/junctions.h"
#include "world/limits.h"
#include "world/settling.h"

namespace verlet_cable {

namespace {

/// Of each segment, as `section_at`.
std::vector<int> sections_of(const CableDesc& desc) {
  std::vector<int> sections(desc.segments, -1);
  for (int i = 0; i < desc.segments && !desc.sections.empty(); ++i) sections[i] = section_at(desc, i);
  return sections;
}

CableModel make_model(const SceneDesc& scene, const CableDesc& desc) {
  CableModel model;
  model.name = desc.name;
  const std::vector<int> sections = sections_of(desc);
  // One that is of one section's material all along has no other.
  const bool is_uniform = std::all_of(sections.begin(), sections.end(), [&](int section) { return section == sections.front(); });
  model.material_name = is_uniform && sections.front() >= 0 ? desc.sections[sections.front()].material : desc.material;
  model.material = *scene.find_material(model.material_name);
  for (const SectionDesc& section : desc.sections)
    if (!is_uniform && find_material(model, section.material) < 0)
      model.section_materials.push_back({section.material, *scene.find_material(section.material)});
  model.color = desc.color;
  model.segment_length = desc.length / desc.segments;
  return model;
}

/// Its lengths and masses; all nodes at the origin.
CableState make_state(const CableModel& model, const CableDesc& desc) {
  CableState state;
  const double length = model.segment_length;
  state.rest_lengths.assign(desc.segments, length);
  state.masses.assign(desc.segments + 1, 0.0);
  if (!model.section_materials.empty())
    for (const int section : sections_of(desc))
      state.section_material.push_back(section < 0 ? 0 : find_material(model, desc.sections[section].material));
  const CableMaterials materials(model, state);
  for (int i = 0; i < desc.segments; ++i) {
    state.masses[i] += 0.5 * length * materials[i].linear_density;
    state.masses[i + 1] += 0.5 * length * materials[i].linear_density;
  }
  for (const PointMassDesc& point : desc.point_masses) state.masses[node_at(desc, point.place)] += point.mass;
  state.positions.assign(state.nodes(), Vector3::Zero());
  state.velocities.assign(state.nodes(), Vector3::Zero());
  return state;
}

bool frame_known(const std::string& name, const FrameIds& ids, const BoundaryInputs& inputs) {
  const auto frame = static_cast<std::size_t>(ids.at(name));
  return frame == 0 || (frame < inputs.size() && inputs[frame].known && is_sound(inputs[frame].pose));
}

template <class Desc>
bool frames_known(const Desc& desc, const FrameIds& ids, const BoundaryInputs& inputs) {
  return std::all_of(desc.attachments.begin(), desc.attachments.end(),
                     [&](const auto& attachment) { return frame_known(attachment.frame, ids, inputs); });
}

bool guides_known(const SceneDesc& scene, const CableDesc& desc, const FrameIds& ids, const BoundaryInputs& inputs) {
  return std::all_of(scene.guides.begin(), scene.guides.end(), [&](const GuideDesc& guide) {
    return guide.cable != desc.name || !guide.place || !guide.body.empty() || frame_known(guide.frame, ids, inputs);
  });
}

/// The indices for which `starts` is true; the others stay.
template <class Starts>
std::vector<int> take_out(std::vector<int>& waiting, const Starts& starts) {
  std::vector<int> taken;
  std::copy_if(waiting.begin(), waiting.end(), std::back_inserter(taken), starts);
  waiting.erase(std::remove_if(waiting.begin(), waiting.end(), starts), waiting.end());
  return taken;
}

/// Adds, to the cables that settle, of those that have just started the ones that start by default, where bodies without poses of
/// their own would be put inside an obstacle.
void add_those_inside_obstacles(const std::vector<int>& descs, State& state, Workspace& workspace, std::vector<char>& settles) {
  if (state.obstacles.empty()) return;
  const SceneDesc& scene = *state.scene;
  std::vector<char> has_default(state.cables.size(), 0), has_no_pose(state.bodies.size(), 0);
  for (const int i : descs)
    if (scene.cables[i].initial.type == InitialShapeDesc::Type::automatic)
      has_default[find(state.cables, scene.cables[i].name)] = 1;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) has_no_pose[b] = has_pose(scene.bodies[b]) ? 0 : 1;
  Islands islands;
  islands.build(state);
  for (const Island& island : islands.all()) {
    if (island.bodies.empty() || !BodySettling(island, state, workspace).is_inside_obstacle(has_no_pose)) continue;
    for (const int cable : island.cables)
      if (has_default[cable] != 0) settles[cable] = 1;
  }
}

}  // namespace

int Frames::find(const std::string& name) const {
  return static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
}

FrameIds Frames::ids() const {
  FrameIds ids{{"", 0}};
  for (std::size_t i = 0; i < names.size(); ++i) ids.emplace(names[i], static_cast<int>(i));
  return ids;
}

bool is_sound(const Pose& pose) {
  const double length = pose.orientation.norm();
  return (pose.position.cwiseAbs().array() <= coordinate.highest).all() && length >= 0.5 && length <= 2;
}

bool World::settle() {
  Implementation& w = *implementation_;
  const double energy_before = energy().total();
  w.findings.unsettled.clear();
  w.forget_last_step();
  for (Attachment& attachment : w.state.attachments) attachment.force = attachment.torque = Vector3::Zero();
  for (BodyProgress& body : w.state.body_progress) body.joints.clear();
  for (int cable = 0; cable < static_cast<int>(w.state.cables.size()); ++cable) {
    const KinematicTargets& targets = w.state.cable_progress[cable].targets;
    if (targets.nodes.empty() || follows_bodies(targets, w.state.attachments)) continue;
    if (!Settling(cable, w.state, w.workspaces.value.local()).settle())
      w.findings.unsettled.push_back(w.state.cables[cable].model->name);
  }
  settle_bodies(std::vector<char>(w.state.cables.size(), 1), false, w.state, w.workspaces.value.local(), w.findings.unsettled);
  for (int cable = 0; cable < static_cast<int>(w.state.cables.size()); ++cable) w.yield_to_shape(cable);
  w.told_unsettled = 0;
  w.note_unsettled(0);
  w.account_for_edit_since(energy_before);
  return w.findings.unsettled.empty();
}

std::string vector_problem(const std::string& field, const Vector3& vector, const Range& range, const char* unit) {
  for (int axis = 0; axis < 3; ++axis)
    if (!range.contains(vector[axis]))
      return field + "." + "xyz"[axis] + ": " + number_text(vector[axis]) + "; allowed: " + range.text(unit);
  return "";
}

std::string pose_problem(const std::string& field, const Pose& pose) {
  if (const std::string problem = vector_problem(field + ".position", pose.position, coordinate, "m"); !problem.empty())
    return problem;
  if (is_sound(pose)) return "";
  return field + ".orientation: of length " + number_text(pose.orientation.norm()) +
         "; allowed: 1 (from 0.5 to 2 is brought to 1)";
}

World::World(const SceneDesc& scene, const BoundaryInputs& inputs, const std::atomic<bool>* cancelled) : World(scene) {
  implementation_->cancelled = cancelled;
  implementation_->update_frames(inputs);
  start_waiting(inputs);
  implementation_->cancelled = nullptr;
}

World::World(const SceneDesc& scene) : implementation_(std::make_unique<Implementation>()) {
  std::vector<std::string> errors = validate(scene);
  if (errors.empty()) errors = too_many_coupled_places(scene);
  if (errors.empty()) errors = not_simulated_guides(scene);
  if (!errors.empty()) throw SceneError(std::move(errors));
  Implementation& w = *implementation_;
  w.state.scene = std::make_shared<const SceneDesc>(scene);
  w.state.waves = waves_of(scene);
  w.state.frames.names = frame_names(scene);
  w.state.frames.poses.resize(w.state.frames.names.size());
  w.state.frames.previous_poses.resize(w.state.frames.names.size());
  w.state.frames.earlier_poses.resize(w.state.frames.names.size());
  w.state.frames.known.assign(w.state.frames.names.size(), false);
  w.state.frames.known.front() = true;
  w.add_bodies();
  w.add_junctions();
  w.add_scene_obstacles();
  for (int i = 0; i < static_cast<int>(scene.cables.size()); ++i) w.state.waiting_cables.push_back(i);
  for (int i = 0; i < static_cast<int>(scene.nets.size()); ++i) w.state.waiting_nets.push_back(i);
  w.name_waiting();
  for (const ParticleDesc& particle : scene.particles) w.add_particle(particle);
  w.update_frames({});
  w.begin_account(0);
}

World::~World() = default;
World::World(const World& other) : implementation_(std::make_unique<Implementation>(*other.implementation_)) {}
World& World::operator=(const World& other) {
  if (!implementation_) return *this = World(other);  // it had been moved from
  *implementation_ = *other.implementation_;
  return *this;
}
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

int World::start_waiting(const BoundaryInputs& inputs) {
  Implementation& w = *implementation_;
  if (w.is_cancelled() || (w.state.waiting_cables.empty() && w.state.waiting_nets.empty())) return 0;
  const FrameIds ids = w.state.frames.ids();
  const SceneDesc& scene = *w.state.scene;
  // Those of a harness start together.
  const std::vector<int> harnesses = harnesses_of(scene);
  std::vector<char> waits(scene.cables.size(), 0);
  for (const int i : w.state.waiting_cables)
    if (!frames_known(scene.cables[i], ids, inputs) || !guides_known(scene, scene.cables[i], ids, inputs) ||
        !w.has_bodies_of(scene.cables[i]))
      waits[harnesses[i]] = 1;
  std::vector<int> cables =
      w.with_trunks_first(take_out(w.state.waiting_cables, [&](int i) { return waits[harnesses[i]] == 0; }));
  const auto given =
      std::stable_partition(cables.begin(), cables.end(), [&](int i) { return places_bodies(scene, scene.cables[i]); });
  const std::vector<int> nets = take_out(w.state.waiting_nets, [&](int i) { return frames_known(scene.nets[i], ids, inputs); });
  if (cables.empty() && nets.empty()) return 0;
  const double of_nets = w.energy_of_nets_and_particles();
  w.update_frames(inputs);
  for (auto i = cables.begin(); i != cables.end(); ++i) {
    if (w.is_cancelled()) break;
    if (i == given) w.place_hanging_bodies(cables);
    w.start_cable(scene.cables[*i], ids, inputs);
  }
  w.bring_to_junctions(cables);
  w.weld_junctions(cables);
  w.place_bodies();  // that others hold which cables have placed
  w.settle_started_bodies(cables);
  for (const int i : cables) w.yield_to_shape(find(w.state.cables, scene.cables[i].name));
  for (const int i : nets)
    if (!w.is_cancelled()) w.start_net(scene.nets[i], ids, inputs);
  w.note_unsettled(w.told_unsettled);
  w.name_waiting();
  w.begin_account(of_nets);
  assert_no_violation(w.state);
  return static_cast<int>(cables.size() + nets.size());
}

void World::Implementation::name_waiting() {
  findings.waiting.clear();
  for (const int i : state.waiting_cables) findings.waiting.push_back(state.scene->cables[i].name);
  for (const int i : state.waiting_nets) findings.waiting.push_back(state.scene->nets[i].name);
  for (std::size_t b = 0; b < state.scene->bodies.size(); ++b)
    if (!state.body_progress[b].is_placed) findings.waiting.push_back(state.bodies[b].name);
}

/// With the next one of the frames that are computed.
void World::Implementation::add_body(SimulatedBody body) {
  body.frame = static_cast<int>(state.frames.names.size());
  state.frames.names.push_back(body.name);
  state.frames.poses.push_back(body.pose);
  state.frames.previous_poses.push_back(body.pose);
  state.frames.known.push_back(false);
  state.body_progress.emplace_back();
  state.bodies.push_back(std::move(body));
}

/// With their frames, after those of the scene, and with what holds them.
void World::Implementation::add_bodies() {
  const FrameIds ids = state.frames.ids();
  for (const BodyDesc& desc : state.scene->bodies) {
    const int index = static_cast<int>(state.bodies.size());
    add_body(make_body(desc));
    for (const BodyAttachmentDesc& a : desc.attachments) {
      Attachment attachment;
      attachment.name = a.name;
      attachment.body = rigid_body_id(index);
      attachment.type = a.type;
      attachment.pose = {a.offset, quaternion_from_rpy(a.rotation)};
      attachment.at = pose_of(a.at);
      attachment.frame = a.body.empty() ? ids.at(a.frame) : -1;
      state.attachments.push_back(attachment);
    }
  }
  for (Attachment& attachment : state.attachments) {
    if (attachment.frame >= 0) continue;
    const BodyDesc& held = state.scene->bodies[attachment.body.index];
    const auto desc = std::find_if(held.attachments.begin(), held.attachments.end(),
                                   [&](const BodyAttachmentDesc& a) { return a.name == attachment.name; });
    attachment.holder = find(state.bodies, desc->body);
    attachment.frame = state.bodies[attachment.holder].frame;
  }
}

/// A frame that is unknown, or whose pose is not sound, stays where it was; the first of the latter is returned, else -1. The
/// fixed frame does not move.
int World::Implementation::update_frames(const BoundaryInputs& inputs) {
  int ignored = -1;
  state.frames.earlier_poses.swap(state.frames.previous_poses);
  state.frames.previous_poses = state.frames.poses;
  for (std::size_t i = 1; i < std::min(state.frames.poses.size(), inputs.size()); ++i) {
    if (!inputs[i].known || state.body_of_frame(static_cast<int>(i)) >= 0) continue;
    if (!is_sound(inputs[i].pose)) {
      if (ignored < 0) ignored = static_cast<int>(i);
      continue;
    }
    state.frames.poses[i] = {inputs[i].pose.position, inputs[i].pose.orientation.normalized()};
    if (!state.frames.known[i]) state.frames.earlier_poses[i] = state.frames.previous_poses[i] = state.frames.poses[i];
    state.frames.known[i] = true;
  }
  place_bodies();
  for (Obstacle& obstacle : state.obstacles) obstacle.present = state.frames.known[obstacle.frame];
  return ignored;
}

void World::Implementation::start_cable(const CableDesc& desc, const FrameIds& ids, const BoundaryInputs& inputs) {
  const int index = static_cast<int>(state.cables.size());
  SimulatedCable cable;
  CableModel model = make_model(*state.scene, desc);
  std::vector<Attachment> holding = junction_attachments(desc, index);
  const bool branches = !holding.empty();
  for (const AttachmentDesc& a : desc.attachments) {
    Attachment& attachment = holding.emplace_back();
    attachment.name = a.name;
    attachment.body = cable_id(index);
    attachment.node = node_at(desc, a.place);
    attachment.holder = a.body.empty() ? -1 : find(state.bodies, a.body);
    attachment.frame = attachment.holder < 0 ? ids.at(a.frame) : state.bodies[attachment.holder].frame;
    attachment.type = a.type;
    attachment.pose = {a.offset, quaternion_from_rpy(a.rotation)};
  }
  model.turns_bodies = turns_bodies(index, holding, state);
  model.is_twisted = is_twisted(index, holding);
  cable.state = make_state(model, desc);
  cable.model = std::make_shared<const CableModel>(std::move(model));
  std::vector<int> own;
  std::vector<Attachment> placing;  // bodies that begin where the cable ends
  for (const Attachment& attachment : holding) {
    if (attachment.holder >= 0 && !state.body_progress[attachment.holder].is_placed) {
      placing.push_back(attachment);
      continue;
    }
    own.push_back(static_cast<int>(state.attachments.size()));
    state.attachments.push_back(attachment);
  }
  add_guides(desc, index, ids, *cable.model, cable.state, state, own, placing);
  // The holders catch the nodes where they want them: there is no gap to close.
  CableProgress memory;
  memory.id = state.new_cable_id();
  memory.targets = find_targets(*cable.model, cable.state, state.attachments, own, state.frames.poses, {}, state.time());
  for (KinematicTarget& target : memory.targets.nodes) {
    target.gap.setZero();
    target.caught = -infinity;
  }
  for (DirectionTarget& target : memory.targets.directions) target.gap.setIdentity();
  aim_targets(cable.state, state.attachments, state.frames.poses, state.time(), memory.targets);
  put_at_aim(memory.targets);
  start_targets(state.attachments, state.frames.poses, inputs, state.scene->jump_speed, memory.targets);
  start_with_bodies(cable.state, memory.targets);
  Boundary boundary;
  hold_at(1, 1, memory.targets, boundary);
  for (HeldNode& held : boundary.nodes) held.body = state.attachments[held.attachment].holder;
  const Vector3 gravity =
      hanging_gravity(cable, placing, boundary.nodes.empty() ? Vector3(Vector3::Zero()) : boundary.nodes.front().position);
  const bool settles = settles_at_start(desc, *cable.model, cable.state);
  const std::optional<InitialShapeDesc> from_trunk = shape_from_trunk(desc);
  const bool has_frames = is_whole_rod(*cable.model, cable.state) || desc.rest_twist != 0 ||
                          desc.rest_curvature.type != RestCurvatureDesc::Type::straight;
  const Folds fewest = boundary.directions.empty() || has_frames || branches ? Folds::nowhere : Folds::at_holders;
  const Folds folds = settles ? fewest : Folds::anywhere;
  const bool is_spread =
      folds == Folds::nowhere && is_held_between_ends(boundary.nodes, cable.state) && boundary.nodes.front().body < 0;
  const bool has_shape =
      set_initial_state(from_trunk.value_or(desc.initial), folds, *cable.model, boundary.nodes, gravity, cable.state);
  const bool is_closed = close_loops(holding, cable_id(index), desc.initial.is_given(), boundary.nodes, gravity, cable);
  if ((!has_shape && !from_trunk) || (!is_closed && desc.initial.is_given())) findings.misfits.push_back(desc.name);
  // Where velocities of holders are not known yet, the first step finds them, and all go together.
  const auto starts = [](const KinematicTarget& target) { return target.starts; };
  const bool moves = std::none_of(memory.targets.nodes.begin(), memory.targets.nodes.end(), starts);
  if (moves) project_velocities(*cable.model, boundary.nodes, cable.state);
  cable.state.twist.assign(cable.state.segments(), 0.0);
  cable.state.reference_orientation = smallest_rotation(Vector3::UnitX(), cable.state.positions[1] - cable.state.positions[0]);
  set_stiff_ends(desc.stiff_ends, cable.state);
  set_rest_shape(desc, *cable.model, cable.state);
  fit_bending_memory(*cable.model, cable.state);
  if (is_whole_rod(*cable.model, cable.state)) start_frames(memory.targets.directions, cable.state);
  if (desc.rest_curvature.type == RestCurvatureDesc::Type::initial && !cable.state.rest_curvature.empty())
    take_rest_curvature(memory.targets.directions, cable.state);
  memory.spans = find_spans(cable.state, boundary.directions);
  follow_material(*cable.model, boundary.directions, memory.spans, cable.state);
  watch_limits(cable);
  const bool held = !memory.targets.nodes.empty();
  state.cables.push_back(std::move(cable));
  state.cable_progress.push_back(std::move(memory));
  if (moves && slides(state.cable_progress[index].targets)) move_with_holders(index, state);
  // What is joined settles together; a trunk that was spread out settles alone before that.
  const bool settles_alone = settles && held && (!branches || is_spread);
  const bool is_default = desc.initial.type == InitialShapeDesc::Type::automatic;
  const bool may_lie = is_default && held && !state.obstacles.empty();
  if (settles_alone || may_lie) {
    Settling settling(index, state, workspaces.value.local(), cancelled);
    if (settles_alone || settling.hangs_into_something()) {
      const bool is_settled = settling.settle_start();
      if (!is_settled && !branches) findings.unsettled.push_back(desc.name);
      if (branches) close_loops(holding, cable_id(index), false, boundary.nodes, gravity, state.cables[index]);
    }
  }
  place_bodies_on(placing);
}

/// Bodies whose cables have just started settle with those that are to, and those that would start inside an obstacle. They begin
/// to move from there.
void World::Implementation::settle_started_bodies(const std::vector<int>& descs) {
  if (state.bodies.empty() || is_cancelled()) return;
  std::vector<char> settles(state.cables.size(), 0);
  for (const int i : descs) {
    const CableDesc& desc = state.scene->cables[i];
    const int cable = find(state.cables, desc.name);
    settles[cable] = settles_at_start(desc, *state.cables[cable].model, state.cables[cable].state) ? 1 : 0;
  }
  add_those_inside_obstacles(descs, state, workspaces.value.local(), settles);
  const std::vector<SimulatedBody> moving = state.bodies;
  settle_bodies(settles, true, state, workspaces.value.local(), findings.unsettled, cancelled);
  for (std::size_t b = 0; b < moving.size(); ++b) {
    state.bodies[b].velocity = moving[b].velocity;
    state.bodies[b].angular_velocity = moving[b].angular_velocity;
  }
}

/// A cable has frames as long as what it is made of, or what it is held by, needs them.
void World::Implementation::fit_frames(int index) {
  SimulatedCable& cable = state.cables[index];
  const bool turns = turns_bodies(index, state.attachments, state), twisted = is_twisted(index, state.attachments);
  if (turns != cable.model->turns_bodies || twisted != cable.model->is_twisted) {
    CableModel model = *cable.model;
    model.turns_bodies = turns;
    model.is_twisted = twisted;
    cable.model = std::make_shared<const CableModel>(std::move(model));
  }
  fit_bending_memory(*cable.model, cable.state);
  std::vector<DirectionTarget>& clamps = state.cable_progress[index].targets.directions;
  if (is_whole_rod(*cable.model, cable.state))
    give_frames(cable.state, clamps);
  else
    drop_frames(cable.state, clamps);
}

/// What is in its shape at once, not by motion, has yielded as far as that shape wants it.
void World::Implementation::yield_to_shape(int index) {
  if (index < 0 || state.cables[index].state.bending_memory.empty()) return;
  SimulatedCable& cable = state.cables[index];
  const KinematicTargets& targets = state.cable_progress[index].targets;
  std::vector<HeldDirection> directions;
  hold_directions_at(0, 0, targets, directions);
  hold_directions_on_bodies(state.attachments, state.bodies, targets, directions);
  verlet_cable::yield_to_shape(*cable.model, directions, {}, cable.state);
}

/// After a change of what holds a cable, of its nodes, or of its materials.
void World::Implementation::find_targets_of(int index) {
  fit_frames(index);
  SimulatedCable& cable = state.cables[index];
  CableProgress& memory = state.cable_progress[index];
  const KinematicTargets before = memory.targets;
  memory.targets = find_targets(*cable.model, cable.state, state.attachments, attachments_of(cable_id(index), state.attachments),
                                state.frames.poses, before, state.time());
  if (memory.drive) open_clamp(*memory.drive, state.attachments, cable.state.segments(), memory.targets);
  close_gaps_on_bodies(state.attachments, state.bodies, before, memory.targets);
  aim_targets(cable.state, state.attachments, state.frames.poses, state.time(), memory.targets);
  const Boundary boundary = boundary_now(memory.targets);
  restore_lengths(*cable.model, boundary.nodes, gravity_near(state, index), cable.state);
  memory.spans = find_spans(cable.state, boundary.directions);
  measure_joint_twists(memory.targets.directions, cable.state);
}

}  // namespace verlet_cable

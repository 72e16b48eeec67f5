#include "world/junctions.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "rod/initial_shape.h"
#include "rod/loop_shape.h"
#include "rod/rod_frames.h"
#include "scene/scene_materials.h"
#include "scene/validate_holders.h"
#include "verlet_cable/core/cable_materials.h"
#include "verlet_cable/core/rotation.h"
#include "world/implementation.h"

namespace verlet_cable {

namespace {

/// A branch whose end is joined comes from the other side: its material's x goes towards the junction.
const Quaternion reversed(0, 0, 0, 1);
/// Of the length of cable around a node: less from one side of it to the other is a fold, which has no direction to spin about.
constexpr double folded = 1e-6;
/// [of the length between them] Nodes that are to be at one place and are farther apart than this are brought together by a loop.
constexpr double open_as_given = 0.5, open_as_hung = 1e-3;

/// [kg m^2] Of the halves of the segments beside a node about that node. A junction has no inertia of its own: it turns with
/// these, which is less the shorter the segments are, of second order as all that they leave out.
double inertia_around(const SceneDesc& scene, const CableDesc& cable, int node) {
  const double half = 0.5 * cable.length / cable.segments;
  double inertia = 0;
  for (const int segment : {node - 1, node})
    if (segment >= 0 && segment < cable.segments)
      inertia += material_at(scene, cable, segment).linear_density * half * half * half / 3;
  return inertia;
}

}  // namespace

Vector3 spin_at(const CableState& state, int node) {
  const int before = std::max(node - 1, 0), after = std::min(node + 1, state.segments());
  const Vector3 way = state.positions[after] - state.positions[before];
  if (!(way.norm() > folded * state.length(before, after))) return Vector3::Zero();
  return way.cross(state.velocities[after] - state.velocities[before]) / way.squaredNorm();
}

bool close_loops(const std::vector<Attachment>& attachments, BodyId body, bool is_given, const std::vector<HeldNode>& held,
                 const Vector3& gravity, SimulatedCable& cable) {
  CableState& shape = cable.state;
  const std::vector<Vector3> before = shape.positions;
  const double least = is_given ? open_as_given : CableMaterials(cable).any_bends() ? 0 : open_as_hung;
  std::map<int, int> nodes;  // by junction
  bool is_closed = true;
  for (const Attachment& attachment : attachments) {
    if (!attachment.is_junction || attachment.body != body) continue;
    const auto [joined, is_new] = nodes.emplace(attachment.holder, attachment.node);
    if (is_new) continue;
    const auto [first, last] = std::minmax(joined->second, attachment.node);
    if ((shape.positions[last] - shape.positions[first]).norm() < least * shape.length(first, last)) continue;
    lay_loop(first, last, shape);
    is_closed = false;
  }
  if (is_closed) return true;
  carry_frames(before, shape);
  carry_along(*cable.model, held, gravity, shape);
  return false;
}

/// Light bodies where cables branch, after those of the scene. The first cable of a junction that starts places it.
void World::Implementation::add_junctions() {
  const SceneDesc& scene = *state.scene;
  const std::vector<std::string> names = computed_frame_names(scene);
  for (const JunctionDesc& desc : scene.junctions) {
    SimulatedBody body;
    body.name = names[state.bodies.size()];
    body.is_junction = true;
    body.mass = desc.mass;
    add_body(std::move(body));
  }
  for (const CableDesc& cable : scene.cables)
    for (const JunctionPlace& place : junction_places(scene, cable))
      state.bodies[scene.bodies.size() + place.junction].inertia.diagonal().array() += inertia_around(scene, cable, place.node);
}

/// The same cables in an order in which branches follow what they come off, where there is one.
std::vector<int> World::Implementation::with_trunks_first(const std::vector<int>& cables) const {
  const SceneDesc& scene = *state.scene;
  if (scene.junctions.empty()) return cables;
  const NameIndex index = index_of_names(scene.cables);
  std::vector<int> place(scene.cables.size(), -1), waits_for(cables.size(), 0), ordered;
  for (std::size_t i = 0; i < cables.size(); ++i) place[cables[i]] = static_cast<int>(i);
  std::vector<std::vector<int>> branches(cables.size());
  for (const JunctionDesc& junction : scene.junctions) {
    const int trunk = place[index.at(junction.cable)];
    if (trunk < 0) continue;
    for (const BranchDesc& desc : junction.branches) {
      const int branch = place[index.at(desc.cable)];
      if (branch < 0) continue;
      branches[trunk].push_back(branch);
      ++waits_for[branch];
    }
  }
  std::set<int> left, ready;
  for (int i = 0; i < static_cast<int>(cables.size()); ++i) {
    left.insert(i);
    if (waits_for[i] == 0) ready.insert(i);
  }
  while (!left.empty()) {
    const int next = ready.empty() ? *left.begin() : *ready.begin();  // else they come off each other
    left.erase(next);
    ready.erase(next);
    ordered.push_back(cables[next]);
    for (const int branch : branches[next])
      if (--waits_for[branch] == 0 && left.count(branch) > 0) ready.insert(branch);
  }
  return ordered;
}

/// What holds a cable at junctions, as if they held points alone; `weld_junctions` does the rest.
std::vector<Attachment> World::Implementation::junction_attachments(const CableDesc& desc, int cable) const {
  const SceneDesc& scene = *state.scene;
  const std::optional<JunctionPlace> trunk = place_on_trunk(desc);
  std::vector<Attachment> attachments;
  for (const JunctionPlace& place : junction_places(scene, desc)) {
    Attachment& attachment = attachments.emplace_back();
    attachment.name =
        "junction " + scene.junctions[place.junction].name + " of " + desc.name + " at " + std::to_string(place.node);
    attachment.is_junction = true;
    attachment.body = cable_id(cable);
    attachment.node = place.node;
    attachment.holder = static_cast<int>(scene.bodies.size()) + place.junction;
    attachment.frame = state.bodies[attachment.holder].frame;
    // The material of a branch that goes on along its trunk is turned as that's.
    if (!trunk || place.junction != trunk->junction || !is_welded(scene, desc.name) || !bends_at(scene, desc, place.node)) continue;
    attachment.type = AttachmentType::clamp;
    attachment.pose.orientation = quaternion_from_rpy(place.branch->rotation);
    if (place.branch->end == BranchDesc::End::end) attachment.pose.orientation *= reversed;
  }
  return attachments;
}

/// Where a branch that is given no shape goes on along the cable that it comes off, which has started: none where it does not.
std::optional<JunctionPlace> World::Implementation::place_on_trunk(const CableDesc& desc) const {
  using Type = InitialShapeDesc::Type;
  if (desc.initial.type != Type::automatic && desc.initial.type != Type::settled) return std::nullopt;
  const std::vector<JunctionPlace> places = junction_places(*state.scene, desc);
  // One that comes back to where it comes off hangs as a loop.
  if (places.size() == 2 && places[0].junction == places[1].junction) return std::nullopt;
  const auto found = std::find_if(places.begin(), places.end(), [&](const JunctionPlace& place) {
    return place.branch != nullptr && state.body_progress[state.scene->bodies.size() + place.junction].is_placed;
  });
  return found == places.end() ? std::nullopt : std::make_optional(*found);
}

/// Of such a branch: straight on, turned by its rotation.
std::optional<InitialShapeDesc> World::Implementation::shape_from_trunk(const CableDesc& desc) const {
  const std::optional<JunctionPlace> place = place_on_trunk(desc);
  if (!place) return std::nullopt;
  const Pose& junction = state.bodies[state.scene->bodies.size() + place->junction].pose;
  const Vector3 way = desc.length * (junction.orientation * quaternion_from_rpy(place->branch->rotation) * Vector3::UnitX());
  InitialShapeDesc shape;
  shape.type = InitialShapeDesc::Type::straight;
  const bool from_start = place->branch->end == BranchDesc::End::start;
  shape.from = from_start ? junction.position : Vector3(junction.position + way);
  shape.to = from_start ? Vector3(junction.position + way) : junction.position;
  return shape;
}

/// Rigid junctions hold the cables that have just started; what holds a cable where it branches holds the junction.
void World::Implementation::weld_junctions(const std::vector<int>& descs) {
  if (state.scene->junctions.empty()) return;
  for (const int i : descs) {
    const int cable = find(state.cables, state.scene->cables[i].name);
    if (cable < 0) continue;
    bool changes = false;
    for (int a = 0; a < static_cast<int>(state.attachments.size()); ++a) {
      if (state.attachments[a].body != cable_id(cable) || !state.attachments[a].is_junction) continue;
      weld(a);
      changes = true;
    }
    if (changes) find_targets_of(cable);
  }
}

/// Those of the trunk's material, as it is now.
Quaternion World::Implementation::axes_on_trunk(const JunctionDesc& junction) const {
  const SceneDesc& scene = *state.scene;
  const auto desc =
      std::find_if(scene.cables.begin(), scene.cables.end(), [&](const CableDesc& cable) { return cable.name == junction.cable; });
  return axes_at(state.cables[find(state.cables, junction.cable)].state, node_at(*desc, junction.place));
}

/// A cable without bending stiffness passes no moment: a point of it is held. A branch that goes on along its trunk does so
/// unloaded, whatever bends it where it starts, and is rolled as its material comes there; others are held as they come.
void World::Implementation::weld(int index) {
  Attachment& joint = state.attachments[index];
  const SimulatedCable& cable = state.cables[joint.body.index];
  const JunctionDesc& junction = state.scene->junctions[joint.holder - state.scene->bodies.size()];
  const bool goes_on = joint.type == AttachmentType::clamp;
  joint.type = AttachmentType::hinge;
  if (junction.type == JunctionDesc::Type::rigid && bends_at(*cable.model, cable.state, joint.node)) {
    const Quaternion& axes = state.bodies[joint.holder].pose.orientation;
    Quaternion held = axes_at(cable.state, joint.node);
    if (goes_on) {
      const Vector3 along = axes_on_trunk(junction) * joint.pose.orientation * Vector3::UnitX();
      held = smallest_rotation(held * Vector3::UnitX(), along) * held;
    }
    joint.type = AttachmentType::clamp;
    joint.pose.orientation = (axes.conjugate() * held).normalized();
  }
  // As it comes, whatever it was held by until now
  std::vector<DirectionTarget>& clamps = state.cable_progress[joint.body.index].targets.directions;
  clamps.erase(
      std::remove_if(clamps.begin(), clamps.end(), [&](const DirectionTarget& clamp) { return clamp.node == joint.node; }),
      clamps.end());
  for (Attachment& other : state.attachments)
    if (other.body == joint.body && other.node == joint.node && is_named(other)) other.held_junction = joint.holder;
}

}  // namespace verlet_cable

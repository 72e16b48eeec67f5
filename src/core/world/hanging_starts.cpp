#include <algorithm>
#include <cmath>

#include "rod/initial_shape.h"
#include "verlet_cable/core/cable_materials.h"
#include "world/implementation.h"

namespace verlet_cable {

namespace {

/// Relative; a cable that fits less than this does not reach.
constexpr double loose = 1e-3;
/// [of a segment] Holders that have gone less far from each other leave the shape of a cable as it was.
constexpr double moved = 1e-9;

double misfit(const SimulatedCable& cable) {
  const CableMaterials materials(cable);
  double largest = 0;
  for (int i = 0; i < cable.state.segments(); ++i) {
    const double strain = (cable.state.positions[i + 1] - cable.state.positions[i]).norm() / cable.state.rest_lengths[i] - 1;
    largest = std::max(largest, is_elastic(materials[i]) ? 0.0 : std::abs(strain));
  }
  return largest;
}

/// The jump of the holder that is nearest to a node.
Vector3 nearest_jump(int node, const std::vector<HeldNode>& held, const std::vector<Vector3>& jumps) {
  std::size_t nearest = 0;
  for (std::size_t k = 1; k < held.size(); ++k)
    if (std::abs(held[k].node - node) < std::abs(held[nearest].node - node)) nearest = k;
  return jumps.empty() ? Vector3(Vector3::Zero()) : jumps[nearest];
}

}  // namespace

/// Of the cables that start now, with what is known of their holders that do not move with them.
StartPlaces World::Implementation::start_places_of(const std::vector<int>& descs, bool junctions_only) const {
  std::vector<char> start(state.scene->cables.size(), 0);
  for (const int i : descs) start[i] = 1;
  KnownPoses known;
  known.frames[""] = Pose{};
  for (std::size_t f = 0; f < state.frames.names.size(); ++f)
    if (state.frames.known[f] && state.body_of_frame(static_cast<int>(f)) < 0)
      known.frames.emplace(state.frames.names[f], state.frames.poses[f]);
  for (std::size_t b = 0; b < state.scene->bodies.size(); ++b)
    if (state.body_progress[b].is_placed) known.bodies.emplace(state.bodies[b].name, state.bodies[b].pose);
  return find_start_places(*state.scene, start, junctions_only, known);
}

/// Bodies without a pose of their own that several cables hold begin where all of them reach, or as near as they come.
void World::Implementation::place_hanging_bodies(const std::vector<int>& descs) {
  if (state.bodies.empty()) return;
  StartPlaces places = start_places_of(descs, false);
  for (const auto& [body, pose] : places.bodies) {
    if (state.body_progress[body].is_placed) continue;
    state.bodies[body].pose = pose;
    note_placed(body);
  }
  note_unreached(places.errors);
  place_bodies();
}

/// Each once: what bodies do not reach, junctions of their harness do not reach, either.
void World::Implementation::note_unreached(const std::vector<std::string>& lines) {
  for (const std::string& line : lines)
    if (std::find(findings.unreached.begin(), findings.unreached.end(), line) == findings.unreached.end())
      findings.unreached.push_back(line);
}

/// Whether a cable that has just started is not as long as it is, or not where the junctions are that hold it.
bool World::Implementation::is_loose(int index) const {
  const SimulatedCable& cable = state.cables[index];
  if (misfit(cable) > loose) return true;
  const std::vector<KinematicTarget>& nodes = state.cable_progress[index].targets.nodes;
  return std::any_of(nodes.begin(), nodes.end(), [&](const KinematicTarget& target) {
    const Attachment& attachment = state.attachments[target.attachment];
    if (!attachment.is_junction) return false;
    const Vector3 place = (state.frames.poses[attachment.frame] * attachment.pose).position;
    return (cable.state.positions[target.node] - place).norm() * cable.state.segments() > loose * cable.state.length();
  });
}

/// Where cables that have just started do not reach their junctions with the shapes that they have by default, and where bodies
/// hang on junctions, those go to where all reach, and what is in the cables' shapes goes with them.
void World::Implementation::bring_to_junctions(const std::vector<int>& descs) {
  if (state.scene->junctions.empty() || is_cancelled()) return;
  std::vector<int> open;
  const std::vector<int> harnesses = harnesses_of(*state.scene);
  for (const int i : descs) {
    const int cable = find(state.cables, state.scene->cables[i].name);
    if (cable < 0 || slides(state.cable_progress[cable].targets) || !is_loose(cable)) continue;
    for (const int other : descs)
      if (harnesses[other] == harnesses[i] && std::find(open.begin(), open.end(), other) == open.end()) open.push_back(other);
  }
  StartPlaces places = start_places_of(open, true);
  note_unreached(places.errors);
  for (const auto& [junction, place] : places.junctions) {
    SimulatedBody& body = state.bodies[state.scene->bodies.size() + junction];
    body.pose.position = place;
    state.frames.poses[body.frame] = state.frames.previous_poses[body.frame] = body.pose;
  }
  for (const int i : open) {
    const int index = find(state.cables, state.scene->cables[i].name);
    if (places.junctions.empty() || index < 0) continue;
    SimulatedCable& cable = state.cables[index];
    KinematicTargets& targets = state.cable_progress[index].targets;
    const auto aim = [&] {
      aim_targets(cable.state, state.attachments, state.frames.poses, state.time(), targets);
      put_at_aim(targets);
      return boundary_now(targets).nodes;
    };
    // Bodies that hang on it alone go with it.
    std::vector<HeldNode> held = aim();
    std::vector<HeldNode> leading;
    std::vector<Vector3> jumps;
    const auto hangs_alone = [&](const KinematicTarget& target) {
      const Attachment& attachment = state.attachments[target.attachment];
      if (attachment.holder < 0 || state.bodies[attachment.holder].is_junction) return -1;
      const BodyDesc& body = state.scene->bodies[attachment.holder];
      return has_pose(body) || places.bodies.count(attachment.holder) > 0 ? -1 : attachment.holder;
    };
    for (std::size_t k = 0; k < held.size(); ++k) {
      if (hangs_alone(targets.nodes[k]) >= 0) continue;
      leading.push_back(held[k]);
      jumps.push_back(held[k].position - cable.state.positions[held[k].node]);
    }
    for (const KinematicTarget& target : targets.nodes) {
      const int alone = hangs_alone(target);
      if (alone < 0) continue;
      SimulatedBody& body = state.bodies[alone];
      body.pose.position += nearest_jump(target.node, leading, jumps);
      state.frames.poses[body.frame] = state.frames.previous_poses[body.frame] = body.pose;
    }
    held = aim();
    const Vector3 gravity = gravity_near(state, index);
    const bool apart = std::any_of(jumps.begin(), jumps.end(), [&](const Vector3& jump) {
      return (jump - jumps.front()).norm() > moved * cable.model->segment_length;
    });
    if (apart)
      hang_anew(*cable.model, held, gravity, cable.state);
    else
      carry_along(*cable.model, held, gravity, cable.state);
  }
}

}  // namespace verlet_cable

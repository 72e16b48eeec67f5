#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "edit/used_names.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/obstacle_of.h"
#include "verlet_cable/core/quoted_text.h"
#include "verlet_cable/core/scene_fields.h"
#include "verlet_cable/core/world.h"
#include "world/implementation.h"

namespace verlet_cable {

namespace {

/// Indices of the links that are rigidly joined to one, itself included, ascending.
std::vector<int> rigid_links(const std::vector<LinkDesc>& tree, int link) {
  std::vector<int> roots(tree.size());
  for (std::size_t i = 0; i < tree.size(); ++i) roots[i] = tree[i].fixed ? roots[tree[i].parent] : static_cast<int>(i);
  std::vector<int> links;
  for (std::size_t i = 0; i < tree.size(); ++i)
    if (roots[i] == roots[link]) links.push_back(static_cast<int>(i));
  return links;
}

std::string number_problem(const char* key, double value, const Range& range) {
  return range.contains(value) ? "" : std::string(key) + ": " + number_text(value) + "; allowed: " + range.text("m");
}

std::string problem_of(const PlaneShape&) {
  return "";
}
std::string problem_of(const SphereShape& sphere) {
  return number_problem("radius", sphere.radius, positive);
}
template <typename RoundShape>
std::string problem_of(const RoundShape& shape) {
  const std::string radius = number_problem("radius", shape.radius, positive);
  return radius.empty() ? number_problem("length", shape.length, positive) : radius;
}
std::string problem_of(const BoxShape& box) {
  for (const double edge : box.size)
    if (!positive.contains(edge)) return number_problem("size", edge, positive);
  return "";
}
std::string problem_of(const MeshShape& shape) {
  return shape.mesh ? "" : "mesh: missing";
}

std::string problem_of(const Obstacle& obstacle, std::size_t frames) {
  if (obstacle.name.empty()) return "name: empty; allowed: any other";
  if (obstacle.frame < 0 || obstacle.frame >= static_cast<int>(frames))
    return "frame: " + std::to_string(obstacle.frame) + "; allowed: the id of a frame";
  if (const std::string problem = pose_problem("pose", obstacle.pose); !problem.empty()) return problem;
  if (obstacle.friction && !not_negative.contains(*obstacle.friction))
    return "friction: " + number_text(*obstacle.friction) + "; allowed: " + not_negative.text();
  if (!not_negative.contains(obstacle.padding)) return number_problem("padding", obstacle.padding, not_negative);
  return std::visit([](const auto& shape) { return problem_of(shape); }, obstacle.shape);
}

auto find_obstacle(std::vector<Obstacle>& obstacles, const std::string& name) {
  return std::find_if(obstacles.begin(), obstacles.end(), [&](const Obstacle& obstacle) { return obstacle.name == name; });
}

/// Which frames belong to an obstacle: its own, and those of links that no joint can move against it. The fixed frame holds too
/// much to belong to anything.
void find_anchors(const State& state, Obstacle& obstacle) {
  obstacle.holders.clear();
  if (obstacle.frame == 0) return;
  obstacle.holders.push_back(obstacle.frame);
  if (!state.scene->robot) return;
  const std::vector<LinkDesc>& tree = state.scene->robot->tree;
  const auto link =
      std::find_if(tree.begin(), tree.end(), [&](const LinkDesc& l) { return l.name == state.frames.names[obstacle.frame]; });
  if (link == tree.end()) return;
  for (const int i : rigid_links(tree, static_cast<int>(link - tree.begin()))) {
    const int frame = state.frames.find(tree[i].name);
    if (frame > 0 && frame < static_cast<int>(state.frames.names.size()) && frame != obstacle.frame)
      obstacle.holders.push_back(frame);
  }
  std::sort(obstacle.holders.begin(), obstacle.holders.end());
}

/// What is inside of an obstacle that goes, and the numbers of those behind it.
template <class Found>
void leave_out(int obstacle, std::vector<Found>& intrusions) {
  const auto is_in_it = [&](const Found& found) { return found.obstacle == obstacle; };
  intrusions.erase(std::remove_if(intrusions.begin(), intrusions.end(), is_in_it), intrusions.end());
  for (Found& found : intrusions)
    if (found.obstacle > obstacle) --found.obstacle;
}

}  // namespace

EditResult World::Implementation::apply(const edit::SetObstacle& set) {
  Obstacle obstacle = set.obstacle;
  std::string problem = problem_of(obstacle, state.frames.names.size());
  if (const char* other = kind_with_name(obstacle.name, state); problem.empty() && other != nullptr)
    problem = std::string("name: that of a ") + other + "; allowed: names that no cable, net, particle or body has";
  if (!problem.empty()) return refused("obstacle " + in_quotes(obstacle.name) + ": " + problem);
  obstacle.pose.orientation.normalize();
  obstacle.present = state.frames.known[obstacle.frame];
  const std::string name = obstacle.name;
  find_anchors(state, obstacle);
  const auto same = find_obstacle(state.obstacles, name);
  obstacle.id = same == state.obstacles.end() ? state.new_obstacle_id() : same->id;
  if (same == state.obstacles.end()) {
    state.obstacles.push_back(std::move(obstacle));
  } else {
    *same = std::move(obstacle);
  }
  return {true, "", name};
}

EditResult World::Implementation::apply(const edit::RemoveObstacle& remove) {
  const std::string& name = remove.name;
  const auto found = find_obstacle(state.obstacles, name);
  if (found == state.obstacles.end()) return refused("obstacle: " + in_quotes(name) + "; there is no such obstacle");
  const int index = static_cast<int>(found - state.obstacles.begin());
  for (CableProgress& progress : state.cable_progress) forget_obstacle(found->id, progress.contacts);
  for (BodyProgress& progress : state.body_progress) forget_obstacle(found->id, progress.contacts);
  state.obstacles.erase(found);
  leave_out(index, findings.intrusions);
  leave_out(index, findings.body_intrusions);
  findings.contacts.clear();
  findings.body_contacts.clear();
  return {true, "", name};
}

void World::Implementation::add_scene_obstacles() {
  const FrameIds ids = state.frames.ids();
  for (const ObstacleDesc& desc : all_obstacles(*state.scene)) {
    Obstacle obstacle = obstacle_of(desc);
    obstacle.frame = ids.at(desc.frame);
    obstacle.present = state.frames.known[obstacle.frame];
    obstacle.id = state.new_obstacle_id();
    find_anchors(state, obstacle);
    state.obstacles.push_back(std::move(obstacle));
  }
}

void World::Implementation::find_obstacle_anchors() {
  for (Obstacle& obstacle : state.obstacles) find_anchors(state, obstacle);
}

}  // namespace verlet_cable

#include <algorithm>
#include <cmath>

#include "rod/length_projection.h"
#include "rod/rod_frames.h"
#include "verlet_cable/core/cable_materials.h"
#include "world/implementation.h"

namespace verlet_cable {

namespace {

/// Relative; segments that fit less than this are drawn together, until they fit this well.
constexpr double loose = 1e-3, drawn = 1e-5;
constexpr int maximum_sweeps = 20000;

/// A point that the lengths of segments draw at: a node, or a junction or body with all that it holds.
struct Drawn {
  Vector3 place = Vector3::Zero();
  double mobility = 0;  ///< relative
};

/// Nodes of cables as points that may be shared.
struct DrawnCable {
  int cable = 0;
  std::vector<int> points;       ///< by node
  std::vector<Vector3> offsets;  ///< [m] by node, from its point
};

double misfit(const SimulatedCable& cable) {
  const CableMaterials materials(cable);
  double largest = 0;
  for (int i = 0; i < cable.state.segments(); ++i) {
    const double length = cable.state.rest_lengths[i];
    const double too_long = (cable.state.positions[i + 1] - cable.state.positions[i]).norm() / length - 1;
    largest = std::max(largest, is_elastic(materials[i]) ? 0.0 : std::abs(too_long));
  }
  return largest;
}

/// [of a segment] How far nodes are from the junctions that hold them.
double opening(const SimulatedCable& cable, const KinematicTargets& targets, const std::vector<Attachment>& attachments,
               const std::vector<Pose>& frames) {
  double largest = 0;
  for (const KinematicTarget& target : targets.nodes) {
    const Attachment& attachment = attachments[target.attachment];
    if (!attachment.is_junction) continue;
    const Vector3 place = (frames[attachment.frame] * attachment.pose).position;
    const double away = (cable.state.positions[target.node] - place).norm();
    largest = std::max(largest, away * cable.state.segments() / cable.state.length());
  }
  return largest;
}

}  // namespace

/// Where cables that have just started do not reach each other with the shapes that they have by default, what joins them goes to
/// where they do, all segments keeping their lengths (Jakobsen, Advanced Character Physics, 2001); if there is such a place.
void World::Implementation::draw_together(const std::vector<int>& descs) {
  if (state.bodies.empty()) return;
  std::vector<int> started;
  for (const int i : descs) {
    const int cable = find(state.cables, state.scene->cables[i].name);
    if (cable < 0) continue;
    const KinematicTargets& targets = state.cable_progress[cable].targets;
    if (follows_bodies(targets, state.attachments) && !slides(targets)) started.push_back(cable);
  }
  const auto is_loose = [&](int cable) {
    const SimulatedCable& of = state.cables[cable];
    return misfit(of) > loose || opening(of, state.cable_progress[cable].targets, state.attachments, state.frames.poses) > loose;
  };
  if (std::none_of(started.begin(), started.end(), is_loose)) return;

  std::vector<Drawn> points(state.bodies.size());
  for (std::size_t b = 0; b < state.bodies.size(); ++b) points[b].place = state.bodies[b].pose.position;
  std::vector<DrawnCable> cables;
  for (const int index : started) {
    DrawnCable& drawn_cable = cables.emplace_back();
    drawn_cable.cable = index;
    for (const Vector3& place : state.cables[index].state.positions) {
      drawn_cable.points.push_back(static_cast<int>(points.size()));
      drawn_cable.offsets.emplace_back(Vector3::Zero());
      points.push_back({place, 1});
    }
    for (const KinematicTarget& target : state.cable_progress[index].targets.nodes) {
      const Attachment& attachment = state.attachments[target.attachment];
      if (attachment.holder >= 0 && attachment.node != target.node) continue;
      if (attachment.holder < 0) {
        points[drawn_cable.points[target.node]] = {target.position, 0};
        continue;
      }
      const SimulatedBody& body = state.bodies[attachment.holder];
      const bool is_given = !body.is_junction && (state.scene->bodies[attachment.holder].pose.has_value() ||
                                                  !state.scene->bodies[attachment.holder].attachments.empty());
      points[attachment.holder].mobility = is_given ? 0 : 0.5;
      drawn_cable.points[target.node] = attachment.holder;
      drawn_cable.offsets[target.node] = body.pose.orientation * attachment.pose.position;
    }
  }
  // A frame that holds a cable where it branches holds the junction.
  std::vector<int> drawn_as(state.cables.size(), -1);
  for (std::size_t k = 0; k < cables.size(); ++k) drawn_as[cables[k].cable] = static_cast<int>(k);
  for (const Attachment& attachment : state.attachments) {
    if (!attachment.is_junction || drawn_as[attachment.body.index] < 0) continue;
    int& point = cables[drawn_as[attachment.body.index]].points[attachment.node];
    if (point == attachment.holder) continue;
    points[attachment.holder] = {points[point].place, 0};
    point = attachment.holder;
  }

  double worst = infinity;
  const auto draw = [&](const DrawnCable& of, int i) {
    const SimulatedCable& cable = state.cables[of.cable];
    Drawn &a = points[of.points[i]], &b = points[of.points[i + 1]];
    const double mobility = a.mobility + b.mobility, length = cable.state.rest_lengths[i];
    const Vector3 way = b.place + of.offsets[i + 1] - a.place - of.offsets[i];
    const double distance = way.norm(), excess = distance / length - 1;
    if (!(mobility > 0) || !(distance > 0)) return;
    if (is_elastic(CableMaterials(cable)[i]) && excess < 0) return;
    worst = std::max(worst, std::abs(excess));
    const Vector3 correction = (distance - length) / (distance * mobility) * way;
    a.place += a.mobility * correction;
    b.place -= b.mobility * correction;
  };
  for (int sweep = 0; sweep < maximum_sweeps && worst > drawn; ++sweep) {
    worst = 0;
    for (const DrawnCable& of : cables) {
      const int n = state.cables[of.cable].state.segments();
      for (int i = 0; i < n; ++i) draw(of, sweep % 2 == 0 ? i : n - 1 - i);
    }
  }

  for (std::size_t b = 0; b < state.bodies.size(); ++b) {
    SimulatedBody& body = state.bodies[b];
    if (points[b].mobility == 0) continue;
    body.pose.position = points[b].place;
    state.frames.poses[body.frame] = state.frames.previous_poses[body.frame] = body.pose;
  }
  for (const DrawnCable& of : cables) {
    SimulatedCable& cable = state.cables[of.cable];
    const std::vector<Vector3> before = cable.state.positions;
    for (int i = 0; i < cable.state.nodes(); ++i) cable.state.positions[i] = points[of.points[i]].place + of.offsets[i];
    KinematicTargets& targets = state.cable_progress[of.cable].targets;
    aim_targets(cable.state, state.attachments, state.frames.poses, state.time(), targets);
    put_at_aim(targets);
    project_positions(*cable.model, boundary_now(targets).nodes, cable.state);
    carry_frames(before, cable.state);
  }
}

}  // namespace verlet_cable

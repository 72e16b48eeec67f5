#include "guide/node_passing.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "chain/direction.h"
#include "guide/given_node.h"
#include "guide/side.h"
#include "guide/wheel.h"
#include "rod/length_projection.h"
#include "target/length_drive.h"
#include "verlet_cable/core/cable_materials.h"
#include "world/energy.h"
#include "world/island_stepper.h"
#include "world/loads.h"

namespace verlet_cable {

namespace {

/// Of a regular segment: what is left beside a guide when the next node is taken in; one is given out on the other side then.
constexpr double shortest = 0.1;
/// Of a regular segment: where the node that is given out for it is where the cable bends, about as near as what was left: the
/// bend at the guide stands for as much of the cable then.
constexpr double behind = 0.125;
/// So many steps at the speed of the flow are left, too; but no more than `most_ahead` of a segment.
constexpr double steps_ahead = 3;
/// Of a regular segment: an end that cannot go through stops there.
constexpr double stop = 0.15;
/// Of a regular segment: shorter ones are not split.
constexpr double least_split = 0.7;
/// Of what is left when a node is taken in: what is left then on the side on which one was given out last.
constexpr double turning = 0.6;
/// Of a regular segment: so near a node is taken in whichever way a cable that bends flows, and none is given out nearer; of
/// others `shortest`.
constexpr double closest = 0.05;
/// Of a regular segment, where the cable bends as it moves: only shorter ones and longer ones change the number of nodes, which
/// makes its bends stiffer or softer at once.
constexpr double least_divided = 0.4, most_undivided = 2.2;
/// A node that is given out bends no more than this, height over length.
constexpr double steepest = 0.5;

/// The nodes from `first` on have moved by `shift`, the segments likewise.
void renumber(int cable, int first, int shift, State& state) {
  const auto follow = [&](int& node) {
    if (node >= first) node += shift;
  };
  renumber_held(cable, follow, state);
  CableProgress& progress = state.cable_progress[cable];
  for (TwistSpan& span : progress.spans) {
    follow(span.first_node);
    follow(span.last_node);
  }
  if (progress.drive) follow(progress.drive->segment);
}

/// Of what flows from a side.
double way_from(int side) {
  return side == 0 ? 1 : -1;
}

/// With the velocity of the material at the guide instead of the guide's while `change` is made.
template <class Change>
void with_flowing_node(const SimulatedGuide& guide, Attachment& attachment, int side, CableState& state, const Change& change) {
  const Side before = side_of(attachment, side);
  const Vector3 held = state.velocities[before.node];
  state.velocities[before.node] += guide.flow * segment_direction(state, before.segment());
  change();
  state.velocities[side_of(attachment, side).node] = held;
}

void take_in(int index, Attachment& attachment, int side, State& state) {
  SimulatedCable& cable = state.cables[index];
  SimulatedGuide& guide = state.guides[attachment.guide];
  const int node = side_of(attachment, side).neighbour();
  take_off(index, node, state);
  with_flowing_node(guide, attachment, side, cable.state, [&] {
    guide.lost_length += remove_node(node, cable.state);
    renumber(index, node + 1, -1, state);
  });
}

/// Gives a node out, at `near` [m] of rest length from the guide. It is moved in the direction `bulge`, across the cable, until
/// lengths that were lost where others were taken in are there again: it bends as they did.
void give_out(int index, Attachment& attachment, int side, double near, Vector3 bulge, State& state) {
  SimulatedCable& cable = state.cables[index];
  SimulatedGuide& guide = state.guides[attachment.guide];
  const int segment = side_of(attachment, side).segment(), node = segment + 1;
  const double whole = cable.state.rest_lengths[segment];
  const Vector3 along = segment_direction(cable.state, segment);
  with_flowing_node(guide, attachment, side, cable.state, [&] {
    insert_node(segment, side == 0 ? whole - near : near, *cable.model, cable.state);
    renumber(index, node, 1, state);
  });
  bulge -= bulge.dot(along) * along;
  if (is_wheel(attachment) || !(guide.lost_length > 0) || !(bulge.norm() > 0)) return;
  CableState& c = cable.state;
  const std::array<double, 2> lengths{(c.positions[node] - c.positions[node - 1]).norm(),
                                      (c.positions[node + 1] - c.positions[node]).norm()};
  const double stretch = (lengths[0] + lengths[1]) / whole;
  const double square = 2 * stretch * guide.lost_length * lengths[0] * lengths[1] / (lengths[0] + lengths[1]);
  const double height = std::min(std::sqrt(square), steepest * std::min(lengths[0], lengths[1]));
  c.positions[node] += height * bulge.normalized();
  for (const int i : both_sides) {
    const double gained = c.rest_lengths[node - 1 + i] * (std::hypot(1, height / lengths[i]) - 1);
    c.rest_lengths[node - 1 + i] += gained;
    guide.lost_length -= gained;
  }
}

/// What has come to a guide flows through it: the cable is of one material on both sides, each node with the weight that it has.
void continue_material(const Attachment& attachment, int from, CableState& state) {
  if (state.section_material.empty()) return;
  state.section_material[side_of(attachment, 1 - from).segment()] = state.section_material[side_of(attachment, from).segment()];
}

/// Whether material flows at what holds a node: once a guide, also at a wheel, which holds two.
bool flows_at(const KinematicTarget& target, const State& state) {
  const Attachment& attachment = state.attachments[target.attachment];
  return attachment.guide >= 0 && target.node == attachment.node;
}

/// Whether a cable ends at a node with nothing that a guide would stop.
bool is_free_end(const State& state, int index, int node) {
  const SimulatedCable& cable = state.cables[index];
  return (node == 0 || node == cable.state.segments()) && !carries_payload(cable, node) && !is_attached(state, index, node) &&
         !state.cable_progress[index].drive;
}

/// Whether a frame holds a node of a cable, or the body there: what a hand has in its grip.
bool is_in_a_grip(const State& state, int index, int node) {
  const auto held_by_frame = [&](const BodyId& held, int place) {
    return std::any_of(state.attachments.begin(), state.attachments.end(),
                       [&](const Attachment& a) { return a.body == held && a.node == place && a.holder < 0 && a.guide < 0; });
  };
  return held_by_frame(cable_id(index), node) ||
         std::any_of(state.attachments.begin(), state.attachments.end(), [&](const Attachment& a) {
           return a.body == cable_id(index) && a.node == node && a.holder >= 0 && held_by_frame(rigid_body_id(a.holder), 0);
         });
}

/// The node at which the cable ends on a side of a guide.
int end_beside(const Attachment& attachment, int side, const State& state) {
  return side == 0 ? 0 : state.cables[attachment.body.index].state.segments();
}

/// Whether a guide lets what the cable ends with on a side out: a free end; a clip, which takes a cable behind what has passed
/// it, also what a hand has in its grip, as that does not stop.
bool lets_end_out(const Attachment& attachment, int side, const State& state) {
  const int index = attachment.body.index, end = end_beside(attachment, side, state);
  return is_free_end(state, index, end) || (state.guides[attachment.guide].type == GuideDesc::Type::clip &&
                                            is_in_a_grip(state, index, end) && !state.cable_progress[index].drive);
}

/// [m] At rest, from a guide to the end on a side.
double length_to_end(const Attachment& attachment, int side, const State& state) {
  const int node = side_of(attachment, side).node, end = end_beside(attachment, side, state);
  return state.cables[attachment.body.index].state.length(std::min(node, end), std::max(node, end));
}

/// What holds a cable now, with what flows through its guides and what is wound.
Boundary moving_boundary(int index, const State& state) {
  const CableProgress& progress = state.cable_progress[index];
  Boundary boundary = boundary_now(progress.targets);
  load_flows(index, true, state, boundary);
  if (progress.drive) {
    GrowingSegment& growing = boundary.growing.emplace_back();
    growing.segment = progress.drive->segment;
    growing.growth = progress.drive->fed_rate();
    growing.keeps_tension = progress.drive->heeds_tension();
  }
  return boundary;
}

}  // namespace

bool carries_payload(const SimulatedCable& cable, int node) {
  double share = 0;
  if (node > 0) share += 0.5 * cable.state.rest_lengths[node - 1];
  if (node < cable.state.segments()) share += 0.5 * cable.state.rest_lengths[node];
  const double residue = 0.5 * cable.model->segment_length;
  const CableMaterials materials(cable);
  const auto density = [](const MaterialDesc& material) { return material.linear_density; };
  // What a cut has left may be of any of the cable's materials.
  return cable.state.masses[node] > materials.mean_at(node, density) * share + 1.5 * residue * materials.largest(density);
}

bool is_attached(const State& state, int cable, int node) {
  return std::any_of(state.attachments.begin(), state.attachments.end(),
                     [&](const Attachment& a) { return a.body == cable_id(cable) && (a.node == node || last_node(a) == node); });
}

bool is_passable(const State& state, int cable, int node) {
  const SimulatedCable& c = state.cables[cable];
  const std::optional<LengthDrive>& drive = state.cable_progress[cable].drive;
  if (node <= 0 || node >= c.state.segments() || carries_payload(c, node) || is_attached(state, cable, node)) return false;
  const auto& directions = state.cable_progress[cable].targets.directions;
  const auto& nodes = state.cable_progress[cable].targets.nodes;
  const auto holds = [&](const auto& target) { return target.node == node; };
  if (std::any_of(directions.begin(), directions.end(), holds) || std::any_of(nodes.begin(), nodes.end(), holds)) return false;
  return !drive || (node != drive->segment && node != drive->segment + 1);
}

bool runs_out(const Attachment& attachment, const State& state) {
  const SimulatedGuide& guide = state.guides[attachment.guide];
  const double regular = state.cables[attachment.body.index].model->segment_length;
  const double ahead = steps_ahead * state.scene->time_step * std::abs(guide.flow);
  const double least = std::clamp(ahead, shortest * regular, most_ahead * regular);
  return std::any_of(both_sides.begin(), both_sides.end(), [&](int side) {
    if (!(guide.flow * way_from(side) > 0) || !lets_end_out(attachment, side, state)) return false;
    // Had it been as near when it was brought in, it would not have been caught.
    const bool is_free = is_free_end(state, attachment.body.index, end_beside(attachment, side, state));
    return length_to_end(attachment, side, state) < (is_free ? least : std::max(least, guide.capture));
  });
}

int count_flows(int index, const State& state) {
  if (state.guides.empty()) return 0;
  const std::vector<KinematicTarget>& targets = state.cable_progress[index].targets.nodes;
  return static_cast<int>(
      std::count_if(targets.begin(), targets.end(), [&](const KinematicTarget& target) { return flows_at(target, state); }));
}

void load_flows(int index, bool moves, const State& state, Boundary& boundary) {
  boundary.flows.clear();
  if (state.guides.empty()) return;
  const SimulatedCable& cable = state.cables[index];
  for (const KinematicTarget& target : state.cable_progress[index].targets.nodes) {
    if (!flows_at(target, state)) continue;
    const Attachment& attachment = state.attachments[target.attachment];
    const SimulatedGuide& guide = state.guides[attachment.guide];
    GuidedFlow& flow = boundary.flows.emplace_back();
    flow.first = attachment.node;
    flow.last = last_node(attachment);
    if (is_wheel(attachment)) {
      flow.inertia = mass_on_rim(guide);
      flow.resistance = guide.bearing_friction / guide.radius;
      flow.grip = guide.friction;
    } else {
      flow.friction = guide.friction;
    }
    flow.rate = guide.flow;
    flow.acceleration = guide.flow_acceleration;
    flow.held_energy = guide.held_energy;
    flow.held_way = guide.held_way;
    flow.held_length = cable.model->segment_length;
    for (const int side : both_sides) {
      const Side at = side_of(attachment, side);
      if (cable.state.rest_lengths[at.segment()] >= stop * cable.model->segment_length) continue;
      const bool runs_out =
          moves && at.neighbour() == end_beside(attachment, side, state) && lets_end_out(attachment, side, state);
      flow.is_blocked[side] = !runs_out && !is_passable(state, index, at.neighbour());
    }
  }
}

void keep_flows(int index, const Boundary& boundary, State& state) {
  for (const GuidedFlow& flow : boundary.flows)
    for (const KinematicTarget& target : state.cable_progress[index].targets.nodes) {
      const int guide = state.attachments[target.attachment].guide;
      if (guide < 0 || target.node != flow.first) continue;
      state.guides[guide].flow = flow.rate;
      state.guides[guide].flow_acceleration = flow.acceleration;
      state.guides[guide].held_way = flow.held_way;
    }
}

bool pass_nodes(int index, bool moves, State& state) {
  bool passed = false;
  const CableState& cable = state.cables[index].state;
  const bool bends = CableMaterials(state.cables[index]).any_bends(), keeps = moves && bends;
  const double regular = state.cables[index].model->segment_length, little = shortest * regular;
  for (Attachment& attachment : state.attachments) {
    if (attachment.guide < 0 || attachment.body != cable_id(index)) continue;
    const auto length = [&](int side) { return cable.rest_lengths[side_of(attachment, side).segment()]; };
    const auto is_winding = [&](int side) {
      const std::optional<LengthDrive>& drive = state.cable_progress[index].drive;
      return drive && drive->segment == side_of(attachment, side).segment();  // its winch gives nodes out
    };
    const double ahead = steps_ahead * state.scene->time_step * std::abs(state.guides[attachment.guide].flow);
    const double least = std::clamp(ahead, little, most_ahead * regular);
    SimulatedGuide& guide = state.guides[attachment.guide];
    // What the cable has less in energy then goes on to drive what flows, what it has more that gives: its energy is continuous.
    // What masses that come together lose in motion is lost.
    const auto hold = [&](double way, const auto& change) {
      const Energy before = moves ? energy_of_cable(state, index) : Energy();
      change(before);
      passed = true;
      if (!moves) return;
      guide.held_energy *= held_part(guide.held_way / regular);
      guide.held_way = 0;
      guide.last_way = way;
      yield_to_given_nodes(index, state);
      const Energy after = energy_of_cable(state, index);
      const double moved = std::max(0.0, before.kinetic - after.kinetic);
      guide.held_energy += before.total() - after.total() - moved;
    };
    // What flows away from a node does not pass it, though the guide is still near it; what turns round passes back a little
    // behind where it passed.
    const auto comes_to = [&](int side) {
      const double way = way_from(side), limit = keeps && guide.last_way * way < 0 ? turning * least : least;
      return length(side) < limit && (guide.flow * way > 0 || length(side) < (keeps ? closest * regular : little));
    };
    for (const int side : both_sides) {
      while (comes_to(side) && is_passable(state, index, side_of(attachment, side).neighbour())) {
        hold(way_from(side), [&](const Energy& before) {
          const int joint = side_of(attachment, side).neighbour();
          const Vector3 bulge = segment_direction(cable, joint - 1) - segment_direction(cable, joint);
          const double near = std::max(length(side), least);
          take_in(index, attachment, side, state);
          if (length(1 - side) > (keeps ? least_divided : least_split) * regular && !is_winding(1 - side)) {
            if (keeps) {
              give_out(index, attachment, 1 - side, near, Vector3::Zero(), state);
              place_given_node(index, attachment, 1 - side, bulge, before.potential(), state);
            } else {
              give_out(index, attachment, 1 - side, bends ? behind * regular : std::max(length(1 - side) - regular, 2 * little),
                       bulge, state);
            }
          }
          continue_material(attachment, side, state.cables[index].state);
          put_on(index, side_of(attachment, 1 - side).neighbour(), state);
        });
      }
    }
    const double longest = keeps ? most_undivided * regular : regular + std::max(2.5 * little, least);
    for (const int side : both_sides)
      while (length(side) > longest && !is_winding(side))
        hold(-way_from(side),
             [&](const Energy&) { give_out(index, attachment, side, length(side) - regular, Vector3::Zero(), state); });
  }
  return passed;
}

void hold_gain(int index, double gain, State& state) {
  std::vector<SimulatedGuide*> passed;
  for (const Attachment& attachment : state.attachments) {
    if (attachment.guide < 0 || attachment.body != cable_id(index)) continue;
    SimulatedGuide& guide = state.guides[attachment.guide];
    if (guide.last_way != 0 && guide.held_way == 0) passed.push_back(&guide);
  }
  for (SimulatedGuide* guide : passed) guide->held_energy -= std::max(0.0, gain) / static_cast<double>(passed.size());
}

void stop_at_pin(int pin, State& state) {
  const Attachment& attachment = state.attachments[pin];
  const int index = attachment.body.index;
  KinematicTargets& targets = state.cable_progress[index].targets;
  if (!slides(targets) || follows_bodies(targets, state.attachments)) return;
  const Frames& frames = state.frames;
  const Vector3 way = (frames.poses[attachment.frame] * attachment.pose).position -
                      (frames.previous_poses[attachment.frame] * attachment.pose).position;
  const Vector3 velocity = way / state.scene->time_step;
  for (KinematicTarget& target : targets.nodes)
    if (target.attachment == pin)
      target.velocity = target.mean_velocity = target.frame_velocity = target.average_velocity = velocity;
  Boundary boundary = moving_boundary(index, state);
  project_velocities(*state.cables[index].model, boundary, state.cables[index].state);
  keep_flows(index, boundary, state);
}

void move_with_holders(int index, State& state) {
  Boundary boundary = moving_boundary(index, state);
  project_velocities(*state.cables[index].model, boundary, state.cables[index].state);
  keep_flows(index, boundary, state);
}

}  // namespace verlet_cable

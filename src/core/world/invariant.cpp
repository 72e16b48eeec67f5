#include "world/invariant.h"

#include <algorithm>
#include <cassert>
#include <cstdio>

#include "chain/node_arrays.h"
#include "world/holding_bodies.h"

namespace verlet_cable {

namespace {

/// Remembers the first of all that does not hold.
class Check {
 public:
  void require(bool holds, const std::string& of, const char* what) {
    if (!holds && first_.empty()) first_ = of + ": " + what;
  }
  const std::string& first() const { return first_; }

 private:
  std::string first_;
};

bool is_index(int index, std::size_t size) {
  return index >= 0 && index < static_cast<int>(size);
}

void check_arrays(const SimulatedCable& cable, Check& check) {
  const CableState& state = cable.state;
  const std::string& name = cable.model->name;
  const auto nodes = state.masses.size(), segments = state.rest_lengths.size();
  check.require(segments >= 1 && nodes == segments + 1, name, "has a node more than segments");
  // The visits skip what is empty and may be.
  visit_node_arrays(state, [&](const auto& array) { check.require(array.size() == nodes, name, "arrays have an entry a node"); });
  visit_segment_arrays(
      state, [&](const auto& array) { check.require(array.size() == segments, name, "arrays have an entry a segment"); });
  const bool has_frames = !state.directors.empty();
  check.require(has_frames == !state.spin.empty() && has_frames == !state.joint_twist.empty(), name,
                "has directors, spins and joint twists, or none of them");
  for (const int material : state.section_material)
    check.require(is_index(material, cable.model->section_materials.size() + 1), name, "is of materials that its model has");
  check.require(is_index(state.reference_node, nodes), name, "has its reference node");
}

void check_progress(const State& state, int index, Check& check) {
  const SimulatedCable& cable = state.cables[index];
  const CableProgress& progress = state.cable_progress[index];
  const std::string& name = cable.model->name;
  const auto nodes = cable.state.masses.size(), segments = cable.state.rest_lengths.size();
  const auto check_targets = [&](const auto& targets) {
    int last = 0;
    for (const auto& target : targets) {
      check.require(
          is_index(target.attachment, state.attachments.size()) && state.attachments[target.attachment].body == cable_id(index),
          name, "is held by attachments of its own");
      check.require(is_index(target.node, nodes) && target.node >= last, name, "is held at its nodes, ascending");
      last = target.node;
    }
  };
  check_targets(progress.targets.nodes);
  check_targets(progress.targets.directions);
  for (const TwistSpan& span : progress.spans) {
    check.require(is_index(span.first_holder, progress.targets.directions.size()) &&
                      is_index(span.last_holder, progress.targets.directions.size()),
                  name, "twists between clamps that it has");
    check.require(span.first_node >= 0 && span.first_node < span.last_node && is_index(span.last_node, nodes), name,
                  "twists between its nodes");
  }
  check.require(progress.spans.empty() || cable.state.directors.empty(), name, "has spans of twist or frames, not both");
  check.require(!progress.drive || is_index(progress.drive->segment, segments), name, "is wound at one of its segments");
  check.require(cable.model->turns_bodies == turns_bodies(index, state.attachments, state), name,
                "knows whether it turns bodies");
  check.require(cable.model->is_twisted == is_twisted(index, state.attachments), name, "knows whether clamps twist it");
  check.require(cable.state.directors.empty() != is_whole_rod(*cable.model, cable.state), name,
                "has frames if it needs them, and only then");
}

void check_attachment(const State& state, const Attachment& a, Check& check) {
  check.require(is_index(a.frame, state.frames.names.size()), a.name, "is held by a frame that is there");
  check.require(a.holder == -1 || is_index(a.holder, state.bodies.size()), a.name, "is held by a body that is there");
  check.require(a.held_junction == -1 || is_index(a.held_junction, state.bodies.size()), a.name,
                "holds a junction that is there");
  check.require(a.guide == -1 || is_index(a.guide, state.guides.size()), a.name, "is a guide that is there");
  const BodyId& body = a.body;
  if (body.is_cable()) {
    const bool is_there = is_index(body.index, state.cables.size());
    check.require(is_there, a.name, "holds a cable that is there");
    if (is_there)
      check.require(is_index(last_node(a), state.cables[body.index].state.masses.size()) && a.node >= 0, a.name,
                    "holds a node that is there");
  }
  if (body.is_net()) {
    const bool is_there = is_index(body.index, state.nets.size());
    check.require(is_there && is_index(a.node, state.nets[body.index].state.positions.size()), a.name,
                  "holds a node of a net that is there");
  }
  if (body.is_rigid_body()) check.require(is_index(body.index, state.bodies.size()), a.name, "holds a body that is there");
}

void check_load(const State& state, const Load& load, Check& check) {
  const BodyId& body = load.body;
  if (body.is_rigid_body())
    return check.require(is_index(body.index, state.bodies.size()), load.name, "acts on a body that is there");
  const bool is_there = body.is_cable() && is_index(body.index, state.cables.size());
  check.require(is_there && is_index(load.node, state.cables[body.index].state.masses.size()), load.name,
                "acts on a node that is there");
}

}  // namespace

std::string violation(const State& state) {
  Check check;
  check.require(state.cable_progress.size() == state.cables.size(), "cables", "each has its progress");
  check.require(state.net_progress.size() == state.nets.size(), "nets", "each has its progress");
  check.require(state.body_progress.size() == state.bodies.size(), "bodies", "each has its progress");
  if (!check.first().empty()) return check.first();
  for (const SimulatedCable& cable : state.cables) check_arrays(cable, check);
  for (const Attachment& attachment : state.attachments) check_attachment(state, attachment, check);
  for (const Load& load : state.loads) check_load(state, load, check);
  // These read arrays by what was checked until here.
  for (int i = 0; check.first().empty() && i < static_cast<int>(state.cables.size()); ++i) check_progress(state, i, check);
  for (int b = 0; b < static_cast<int>(state.bodies.size()); ++b)
    for (const KinematicTarget& target : state.body_progress[b].holders)
      check.require(is_index(target.attachment, state.attachments.size()) && held_body(state.attachments[target.attachment]) == b,
                    state.bodies[b].name, "is held by attachments of its own");
  for (const SimulatedGuide& guide : state.guides)
    check.require(is_index(guide.frame, state.frames.names.size()), guide.name, "is in a frame that is there");
  return check.first();
}

void assert_no_violation([[maybe_unused]] const State& state) {
#ifndef NDEBUG
  const std::string what = violation(state);
  if (!what.empty()) std::fprintf(stderr, "verlet_cable: violated: %s\n", what.c_str());
  assert(what.empty());
#endif
}

}  // namespace verlet_cable

#include <algorithm>
#include <string>
#include <utility>

#include "edit/joined_cables.h"
#include "edit/problems.h"
#include "guide/node_passing.h"
#include "guide/side.h"
#include "rod/initial_shape.h"
#include "rod/length_projection.h"
#include "rod/rod_frames.h"
#include "rod/span_shapes.h"
#include "scene/polyline_length.h"
#include "verlet_cable/core/cable_materials.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/scene_fields.h"
#include "world/implementation.h"
#include "world/junctions.h"

namespace verlet_cable {

namespace {

/// Lets material through a guide in pieces that are shorter than what is beside it, so that nodes can pass.
constexpr double most_let_through = 0.5;
/// Of a length: what is no shorter than that lies straight.
constexpr double nearly_straight = 3e-4;
/// As of what begins.
constexpr double most_strain = 1e-3, most_elastic_strain = 0.02;
/// Of a segment's length: nothing goes through a guide that is told where it is.
constexpr double rounding_of_lengths = 1e-9;
/// Of strains that are compared.
constexpr double strain_rounding = 1e-9;
/// [m], [1], [m/s], [1/s] Bodies that are no further from a pose or twist have it.
constexpr double same_pose = 1e-9;

using OfCable = edit::SetState::OfCable;
using OfBody = edit::SetState::OfBody;

bool gives_something(const OfBody& of) {
  return of.pose || of.velocity || of.angular_velocity;
}

/// Errors then name the thing.
bool is_of_several(const edit::SetState& set) {
  return set.cables.size() + set.bodies.size() + set.guides.size() > 1;
}

/// Of vectors for each node [m], [m/s].
void check_nodes(const std::string& field, const std::optional<std::vector<Vector3>>& vectors, const CableState& cable,
                 Problems& problems) {
  if (!vectors) return;
  if (static_cast<int>(vectors->size()) != cable.nodes())
    return problems.add(field + ": " + std::to_string(vectors->size()) + "; must be " + std::to_string(cable.nodes()) +
                        ", one a node");
  for (std::size_t node = 0; node < vectors->size(); ++node) {
    const std::size_t before = problems.text().size();
    problems.check_vector(field + "[" + std::to_string(node) + "]", (*vectors)[node]);
    if (problems.text().size() > before) return;
  }
}

/// What but cables holds a body, or is held by it; empty if nothing is.
std::string not_free(int body, const State& state) {
  for (const Attachment& a : state.attachments) {
    if (a.body == rigid_body_id(body)) return "held by " + a.name;
    if (a.holder == body && !a.body.is_cable()) return "holding " + a.name;
  }
  return "";
}

/// But for rounding.
bool is_pose_of(const SimulatedBody& body, const Pose& pose) {
  const Quaternion turn = body.pose.orientation.conjugate() * pose.orientation.normalized();
  return (pose.position - body.pose.position).norm() <= same_pose && turn.vec().norm() <= same_pose;
}

bool is_twist_of(const SimulatedBody& body, const OfBody& set) {
  const auto is_same = [](const std::optional<Vector3>& given, const Vector3& own) {
    return !given || (*given - own).norm() <= same_pose;
  };
  return is_same(set.velocity, body.velocity) && is_same(set.angular_velocity, body.angular_velocity);
}

void check_body(const OfBody& set, const State& state, Problems& problems) {
  const std::string other = not_free(set.body, state);
  const SimulatedBody& body = state.bodies[set.body];
  if (!state.body_progress[set.body].is_placed) problems.add("pose: the body does not exist until what holds it is known");
  const auto refuse = [&](const std::string& what) {
    problems.add(what + ": of a body " + other + "; allowed: of bodies that nothing but cables holds, or the one that it has");
  };
  if (!other.empty() && set.pose && !is_pose_of(body, *set.pose)) refuse("pose");
  if (!other.empty() && !is_twist_of(body, set)) refuse("twist");
  if (set.pose) {
    const std::string problem = pose_problem("pose", *set.pose);
    if (!problem.empty()) problems.add(problem);
  }
  if (set.velocity) problems.check_vector("twist.linear", *set.velocity);
  if (set.angular_velocity) problems.check_vector("twist.angular", *set.angular_velocity);
}

const Attachment* attachment_of_guide(int guide, const State& state) {
  const auto found =
      std::find_if(state.attachments.begin(), state.attachments.end(), [&](const Attachment& a) { return a.guide == guide; });
  return found == state.attachments.end() ? nullptr : &*found;
}

void check_guide(const edit::SetState::OfGuide& set, const State& state, Problems& problems) {
  const Attachment* attachment = attachment_of_guide(set.guide, state);
  if (!attachment) return problems.add("arc_length: no cable is in the guide");
  const SimulatedCable& cable = state.cables[attachment->body.index];
  const double half = 0.5 * cable.state.length(attachment->node, last_node(*attachment));
  const double least = half + cable.model->segment_length, most = cable.state.length() - least;
  if (!(set.arc_length >= least && set.arc_length <= most))
    problems.add("arc_length: " + number_text(set.arc_length) + "; must be from " + rounded_text(least) + " to " +
                 rounded_text(most) + " m, a segment from either end");
}

/// It begins there.
void put_body(const Pose& pose, int index, State& state) {
  SimulatedBody& body = state.bodies[index];
  body.pose = {pose.position, pose.orientation.normalized()};
  Frames& frames = state.frames;
  frames.poses[body.frame] = frames.previous_poses[body.frame] = frames.earlier_poses[body.frame] = body.pose;
  state.body_progress[index].contacts.clear();
}

/// What the steps before have found of a body is of another motion.
void forget_motion(BodyProgress& progress) {
  progress.acceleration = progress.angular_acceleration = Vector3::Zero();
  progress.has_moved = false;
}

/// What holds a cable now but for some attachments.
std::vector<HeldNode> held_without(const std::vector<int>& attachments, const KinematicTargets& targets) {
  std::vector<HeldNode> held = boundary_now(targets).nodes;
  for (std::size_t k = held.size(); k-- > 0;)
    if (std::count(attachments.begin(), attachments.end(), targets.nodes[k].attachment) > 0)
      held.erase(held.begin() + static_cast<std::ptrdiff_t>(k));
  return held;
}

/// Where bodies hold a cable now, and how fast.
void hold_where_bodies_are(int index, State& state) {
  KinematicTargets& targets = state.cable_progress[index].targets;
  Boundary boundary = boundary_now(targets);
  hold_on_bodies(state.cables[index].state, state.attachments, state.bodies, state.time(), targets, boundary);
  follow_bodies(boundary, targets);
  for (std::size_t k = 0; k < targets.nodes.size(); ++k) {
    if (boundary.nodes[k].body < 0) continue;
    KinematicTarget& target = targets.nodes[k];
    target.position = target.next_position;
    target.velocity = target.mean_velocity = target.frame_velocity = target.average_velocity = target.next_velocity;
  }
  for (std::size_t k = 0; k < targets.directions.size(); ++k)
    if (boundary.directions[k].body >= 0) targets.directions[k].orientation = targets.directions[k].next_orientation;
}

/// Of the span between two of what holds a cable that is stretched most.
double largest_strain_of_spans(int index, const State& state) {
  const std::vector<HeldNode> held = boundary_now(state.cable_progress[index].targets).nodes;
  double strain = -1;
  for (std::size_t k = 1; k < held.size(); ++k) {
    const double length = state.cables[index].state.length(held[k - 1].node, held[k].node);
    strain = std::max(strain, (held[k].position - held[k - 1].position).norm() / length - 1);
  }
  return strain;
}

/// To which a cable may be stretched by what is set: as what begins, and as it is stretched already.
double allowed_strain(int index, const State& before) {
  const double begins = CableMaterials(before.cables[index]).any_rigid() ? most_strain : most_elastic_strain;
  return std::max(begins, largest_strain_of_spans(index, before)) + strain_rounding;
}

/// Of what cannot stretch. A segment on a wheel is held at both of its nodes.
bool has_lengths(const std::vector<HeldNode>& held, const SimulatedCable& cable) {
  const CableMaterials materials(cable);
  std::vector<char> is_held(cable.state.positions.size(), 0);
  for (const HeldNode& h : held) is_held[h.node] = 1;
  for (int i = 0; i < cable.state.segments(); ++i) {
    if (is_elastic(materials[i]) || (is_held[i] && is_held[i + 1])) continue;
    const double length = (cable.state.positions[i + 1] - cable.state.positions[i]).norm();
    if (std::abs(length / cable.state.rest_lengths[i] - 1) > most_strain) return false;
  }
  return true;
}

/// Spans that are as long as what holds them is apart, or hardly longer, have only one shape.
void draw_straight(const std::vector<HeldNode>& held, CableState& cable) {
  for (const HeldNode& h : held) cable.positions[h.node] = h.position;
  for (std::size_t k = 0; k + 1 < held.size(); ++k) {
    const Vector3 span = held[k + 1].position - held[k].position;
    const double length = cable.length(held[k].node, held[k + 1].node);
    if (span.norm() < (1 - nearly_straight) * length) continue;
    double along = 0;
    for (int i = held[k].node; i + 1 < held[k + 1].node; ++i) {
      along += cable.rest_lengths[i];
      cable.positions[i + 1] = held[k].position + along / length * span;
    }
  }
}

/// False if the nodes find no shape near these positions with the cable's lengths between those that hold it.
bool put_at(std::vector<Vector3> positions, const std::vector<HeldNode>& held, SimulatedCable& cable) {
  const std::vector<Vector3> before = std::exchange(cable.state.positions, positions);
  bool found = project_positions(*cable.model, held, cable.state);
  if (!found) {
    cable.state.positions = std::move(positions);
    if (CableMaterials(cable).any_rigid()) draw_straight(held, cable.state);
    const std::vector<Vector3> drawn = cable.state.positions;
    found = project_positions(*cable.model, held, cable.state);
    if (!found) {
      cable.state.positions = drawn;
      found = has_lengths(held, cable);
    }
  }
  if (found) carry_frames(before, cable.state);
  return found;
}

/// Of the cables that follow, a flag a cable; by their index.
std::vector<std::optional<SpanShapes>> shapes_to_follow(const std::vector<char>& follows, const State& state) {
  std::vector<std::optional<SpanShapes>> shapes(follows.size());
  for (std::size_t c = 0; c < follows.size(); ++c) {
    const std::vector<HeldNode> held = boundary_now(state.cable_progress[c].targets).nodes;
    if (follows[c] && !held.empty()) shapes[c].emplace(held, state.cables[c].state);
  }
  return shapes;
}

/// Puts a cable where its shapes go between what holds it now.
void put_between(const SpanShapes& shapes, int index, State& state) {
  SimulatedCable& cable = state.cables[index];
  shapes.apply(*cable.model, boundary_now(state.cable_progress[index].targets).nodes, gravity_near(state, index), cable.state);
}

/// With the lengths that it has between its holders, and no further strained than is `allowed`: near where it is, or hanging.
bool fits(double allowed, int index, State& state) {
  if (largest_strain_of_spans(index, state) > allowed) return false;
  SimulatedCable& cable = state.cables[index];
  const std::vector<HeldNode> held = boundary_now(state.cable_progress[index].targets).nodes;
  if (put_at(cable.state.positions, held, cable)) return true;
  hang_anew(*cable.model, held, gravity_near(state, index), cable.state);
  return has_lengths(held, cable);
}

/// False if a node that is held, or bears something, is in the way.
bool let_through(const edit::SetState::OfGuide& set, const SpanShapes& shapes, State& state) {
  const Attachment& guided = *attachment_of_guide(set.guide, state);
  const double rounding = rounding_of_lengths * state.cables[guided.body.index].model->segment_length;
  if (std::abs(set.arc_length - arc_length_at(guided, state.cables[guided.body.index].state)) <= rounding) return true;
  SimulatedGuide& guide = state.guides[set.guide];
  guide.flow = guide.flow_acceleration = guide.held_energy = guide.held_way = guide.last_way = 0;
  while (true) {
    const Attachment& attachment = *attachment_of_guide(set.guide, state);
    const int index = attachment.body.index;
    CableState& cable = state.cables[index].state;
    double& before = cable.rest_lengths[side_of(attachment, 0).segment()];
    double& after = cable.rest_lengths[side_of(attachment, 1).segment()];
    const double missing = set.arc_length - arc_length_at(attachment, cable);
    const double part = std::clamp(missing, -most_let_through * before, most_let_through * after);
    before += part;
    after -= part;
    const double little = 0.01 * state.cables[index].model->segment_length;
    lay_straight(boundary_now(state.cable_progress[index].targets).nodes, cable);
    const bool passes = pass_nodes(index, false, state);
    put_between(shapes, index, state);
    if (part == missing) return true;
    if (!passes && std::abs(part) < little) return false;
  }
}

}  // namespace

EditResult World::Implementation::apply(const edit::SetState& set) {
  Problems problems(is_of_several(set));
  std::vector<char> is_changed(state.cables.size(), 0);
  for (const OfCable& of : set.cables) {
    if (of.cable < 0 || of.cable >= static_cast<int>(state.cables.size()))
      return refused("cable: " + std::to_string(of.cable) + "; must be the index of a cable");
    is_changed[of.cable] = gives_something(of);
  }
  for (const OfBody& of : set.bodies) {
    if (of.body < 0 || of.body >= static_cast<int>(state.bodies.size()) || state.bodies[of.body].is_junction)
      return refused("body: " + std::to_string(of.body) + "; must be the index of a body that is no junction");
    problems.of(state.bodies[of.body].name);
    check_body(of, state, problems);
    if (!not_free(of.body, state).empty() || !gives_something(of)) continue;  // it is where it was
    for (const Attachment& a : state.attachments)
      if (a.holder == of.body && a.body.is_cable()) is_changed[a.body.index] = 1;
  }
  for (const edit::SetState::OfGuide& of : set.guides) {
    if (of.guide < 0 || of.guide >= static_cast<int>(state.guides.size()))
      return refused("guide: " + std::to_string(of.guide) + "; must be the index of a guide");
    problems.of(state.guides[of.guide].name);
    check_guide(of, state, problems);
    if (const Attachment* a = attachment_of_guide(of.guide, state)) is_changed[a->body.index] = 1;
  }
  // Of what a guide lets through only the step itself knows how many nodes the cable has then.
  if (set.guides.empty())
    for (const OfCable& of : set.cables) {
      problems.of(state.cables[of.cable].model->name);
      check_nodes("positions", of.positions, state.cables[of.cable].state, problems);
      check_nodes("velocities", of.velocities, state.cables[of.cable].state, problems);
    }
  if (!problems.text().empty()) return refused(problems.text());
  return set_checked(set, is_changed);
}

/// As it is given, with the junctions that go with it.
void World::Implementation::put_cable(const OfCable& of, Problems& problems) {
  SimulatedCable& cable = state.cables[of.cable];
  check_nodes("positions", of.positions, cable.state, problems);
  check_nodes("velocities", of.velocities, cable.state, problems);
  if (!problems.text().empty() || !gives_something(of)) return;
  const std::vector<int> joints = joints_that_go_with(of.cable, state);
  std::vector<Quaternion> axes;
  for (const int joint : joints) axes.push_back(axes_at(cable.state, state.attachments[joint].node));
  hold_where_bodies_are(of.cable, state);
  if (of.positions) {
    Errors errors;
    check_polyline_length("positions", *of.positions, cable.state.length(), polyline_length(cable.state.positions), errors);
    if (errors.size() > 0) return problems.add(errors.take().front());
    if (!put_at(*of.positions, held_without(joints, state.cable_progress[of.cable].targets), cable))
      return problems.add("positions: no shape near them has the cable's lengths where its holders are");
  }
  if (of.velocities) cable.state.velocities = *of.velocities;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const Attachment& joint = state.attachments[joints[i]];
    SimulatedBody& junction = state.bodies[joint.holder];
    const Quaternion turn = axes_at(cable.state, joint.node) * axes[i].conjugate();
    if (of.positions) put_body({cable.state.positions[joint.node], turn * junction.pose.orientation}, joint.holder, state);
    if (of.velocities) {
      junction.velocity = cable.state.velocities[joint.node];
      junction.angular_velocity = spin_at(cable.state, joint.node);
    }
    forget_motion(state.body_progress[joint.holder]);
  }
}

/// `is_changed`: a cable, whether it is to be set, or is held by what is.
EditResult World::Implementation::set_checked(const edit::SetState& set, std::vector<char> is_changed) {
  const State before = state;
  const auto refuse = [&](const std::string& message) {
    state = before;
    return refused(message);
  };
  std::vector<double> allowed(state.cables.size());
  for (std::size_t c = 0; c < allowed.size(); ++c)
    if (is_changed[c]) allowed[c] = allowed_strain(static_cast<int>(c), before);
  const bool by_holders = !set.bodies.empty() || !set.guides.empty();
  const std::vector<std::optional<SpanShapes>> shapes =
      shapes_to_follow(by_holders ? is_changed : std::vector<char>(is_changed.size(), 0), before);
  const std::vector<std::optional<SpanShapes>> branches = shapes_to_follow(cables_that_follow(set.cables, before), before);
  for (const OfBody& of : set.bodies) {
    if (!not_free(of.body, state).empty() || !gives_something(of)) continue;
    SimulatedBody& body = state.bodies[of.body];
    if (of.pose) put_body(*of.pose, of.body, state);
    if (of.velocity) body.velocity = *of.velocity;
    if (of.angular_velocity) body.angular_velocity = *of.angular_velocity;
    forget_motion(state.body_progress[of.body]);
  }
  for (std::size_t c = 0; c < is_changed.size(); ++c) {
    if (!is_changed[c]) continue;
    const int index = static_cast<int>(c);
    hold_where_bodies_are(index, state);
    if (shapes[c]) put_between(*shapes[c], index, state);
  }
  for (const edit::SetState::OfGuide& of : set.guides)
    if (!let_through(of, *shapes[attachment_of_guide(of.guide, state)->body.index], state))
      return refuse("arc_length: " + number_text(of.arc_length) + "; the cable of " + state.guides[of.guide].name +
                    " cannot go through as far: something that it bears or that holds it is in the way");
  // With the states of all that hold them.
  for (std::size_t c = 0; c < is_changed.size(); ++c) {
    if (!shapes[c] || fits(allowed[c], static_cast<int>(c), state)) continue;
    const std::string& name = state.cables[c].model->name;
    if (!set.bodies.empty()) return refuse("pose: too far for the cable " + name + "; allowed: where all that hold it reach");
    return refuse("arc_length: too little of the cable " + name +
                  " between what holds it; allowed: where all that hold it reach");
  }
  Problems problems(is_of_several(set));
  for (const OfCable* of : trunks_first(set.cables, before)) {
    problems.of(before.cables[of->cable].model->name);
    put_cable(*of, problems);
    if (!problems.text().empty()) return refuse(problems.text());
  }
  for (std::size_t c = 0; c < is_changed.size(); ++c) {
    const int index = static_cast<int>(c);
    is_changed[c] = is_changed[c] || branches[c];
    if (is_changed[c]) hold_where_bodies_are(index, state);
    if (!branches[c]) continue;
    put_between(*branches[c], index, state);
    if (!fits(allowed_strain(index, before), index, state))
      return refuse("positions: too far for the cable " + state.cables[c].model->name +
                    "; allowed: where all that hold it reach");
  }
  for (std::size_t c = 0; c < is_changed.size(); ++c) {
    if (!is_changed[c]) continue;
    const int index = static_cast<int>(c);
    // What the steps before have found is of another motion.
    CableState& cable = state.cables[c].state;
    for (std::vector<double>* forces : {&cable.tension, &cable.last_tension, &cable.axial_multiplier})
      std::fill(forces->begin(), forces->end(), 0.0);
    std::fill(cable.accelerations.begin(), cable.accelerations.end(), Vector3::Zero());
    cable.yielding = cable.taut_energy = 0;
    after_remeshing(index);
    yield_to_shape(index);
    move_with_holders(index, state);
  }
  return {true, "", ""};
}

}  // namespace verlet_cable

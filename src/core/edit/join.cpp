#include <algorithm>
#include <cmath>
#include <utility>

#include "chain/node_arrays.h"
#include "rod/bending_memory.h"
#include "rod/length_projection.h"
#include "rod/rod_frames.h"
#include "scene/scene_errors.h"
#include "verlet_cable/core/cable_materials.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/scene_fields.h"
#include "world/implementation.h"

namespace verlet_cable {

namespace {

/// [m/s], [m/s^2] With which ends that are apart are drawn together.
constexpr double joining_speed = 2, joining_acceleration = 20;
/// Of a segment's length: how near they are drawn before they are welded.
constexpr double approach = 0.2;
/// Relative, of what a cable between two holders must span.
constexpr double rounding_of_length = 1e-9;

std::string text(const BendingStiffness& stiffness) {
  return stiffness.is_isotropic() ? number_text(stiffness.front()) : list_text(stiffness);
}

/// The first property in which two materials differ; none if they are the same.
std::optional<std::string> difference(const MaterialDesc& first, const MaterialDesc& second) {
  for (const auto& field : material_fields) {
    if (first.*field.member != second.*field.member)
      return std::string(field.key) + " " + number_text(first.*field.member) + " and " + number_text(second.*field.member);
  }
  if (first.bending_stiffness != second.bending_stiffness)
    return bending_stiffness_field.key + (" " + text(first.bending_stiffness)) + " and " + text(second.bending_stiffness);
  return std::nullopt;
}

/// The material's axes, seen in the cable's other direction: x and z turn around.
const Quaternion turned(0, 0, 1, 0);

/// The same cable from its end to its start.
void reverse(CableState& cable) {
  reverse_arrays(cable);
  for (auto& curvature : cable.rest_curvature) curvature[0] = -curvature[0];
  for (double& spin : cable.spin) spin = -spin;
  for (auto& halves : cable.bending_memory) {
    std::swap(halves.front(), halves.back());
    for (HalfBend& half : halves) {
      half.yielded[0] = -half.yielded[0];
      half.slipped[0] = -half.slipped[0];
    }
  }
  cable.reference_node = cable.segments() - cable.reference_node;
  cable.reference_orientation = cable.reference_orientation * turned;
}

/// At the node of two that are to be one: bent, unloaded, half as the one and half as the other. Returns the twist [rad] that the
/// two joints have beyond what they have unloaded.
double join_rest_shapes(int node, CableState& cable) {
  const int gone = node + 1;
  double twist = 0, excess = 0;
  if (!cable.joint_twist.empty()) {
    for (const int i : {node, gone}) excess += cable.joint_twist[i] - rest_angles(cable, i, joint_length(cable, i)).twist;
    twist = cable.joint_twist[node] += cable.joint_twist[gone];
  }
  const double cosine = std::cos(0.5 * twist), sine = std::sin(0.5 * twist);
  if (!cable.bending_memory.empty() && node > 0 && gone < cable.segments()) {
    // What has been bent for good stays so, seen from the joint.
    const auto turned_by = [cosine](double sine, const HalfBend& half) {
      const auto turn = [&](const std::array<double, 2>& bend) {
        return std::array<double, 2>{cosine * bend[0] + sine * bend[1], cosine * bend[1] - sine * bend[0]};
      };
      return HalfBend{turn(half.yielded), turn(half.slipped)};
    };
    const auto& [to_between, from_between] = cable.bending_memory[node];
    HalfBend &before = cable.bending_memory[node - 1].back(), &after = cable.bending_memory[gone].front();
    before = turned_by(sine, sum_of({{1, before}, {1, to_between}}));
    after = turned_by(-sine, sum_of({{1, from_between}, {1, after}}));
  }
  if (cable.rest_curvature.empty()) return excess;
  const auto [before_y, before_z] = cable.rest_curvature[node];
  const auto [after_y, after_z] = cable.rest_curvature[gone];
  cable.rest_curvature[node] = {0.5 * (cosine * (before_y + after_y) + sine * (before_z - after_z)),
                                0.5 * (cosine * (before_z + after_z) - sine * (before_y - after_y))};
  return excess;
}

/// Adds the materials of the sections of `other` to a model, and names them so in the state of the cable that they come from.
void take_over_sections(const CableModel& other, CableModel& model, CableState& state) {
  std::vector<int> names{0};
  for (const NamedMaterial& material : other.section_materials) {
    if (find_material(model, material.name) < 0) model.section_materials.push_back(material);
    names.push_back(find_material(model, material.name));
  }
  for (int& material : state.section_material) material = names[material];
}

/// `first` followed by `second`, with a weightless segment between them that is as long as they are apart.
void append_cable(const CableState& second, CableState& first) {
  const int between = first.segments();
  const double gap = (second.positions.front() - first.positions.back()).norm();
  append(second, first);
  first.rest_lengths[between] = gap;
  if (!first.section_material.empty()) first.section_material[between] = first.section_material[between - 1];
  weld_frames(between, first);
}

template <typename T>
void append(const std::vector<T>& tail, std::vector<T>& array) {
  array.insert(array.end(), tail.begin(), tail.end());
}

/// An end that is to be joined: the next attachment from there on, and how much cable is between.
struct JointEnd {
  int node = 0;
  const Attachment* next = nullptr;
  double length = 0;  ///< [m]
};

JointEnd find_end(const CableState& state, int cable, bool at_end, const std::vector<Attachment>& attachments) {
  JointEnd end;
  end.node = at_end ? state.segments() : 0;
  for (const Attachment& a : attachments) {
    if (a.body != cable_id(cable)) continue;
    const double length = state.length(std::min(a.node, end.node), std::max(a.node, end.node));
    if (end.next && length >= end.length) continue;
    end.next = &a;
    end.length = length;
  }
  return end;
}

}  // namespace

EditResult World::Implementation::apply(const edit::Join& join) {
  const auto [first, first_at_end, second, second_at_end] = join;
  const int count = static_cast<int>(state.cables.size());
  for (const int index : {first, second})
    if (index < 0 || index >= count) return refused("cable: " + std::to_string(index) + "; must be the index of a cable");
  const CableModel &model = *state.cables[first].model, &other = *state.cables[second].model;
  if (first == second) return refused("second: " + other.name + "; must be another cable than first");
  for (const int index : {first, second})
    if (state.cable_progress[index].drive)
      return refused("cable: " + state.cables[index].model->name +
                     "; it is still being wound by its winch or drawn together by an earlier join; wait until that is done, and "
                     "set a length without max_tension where a winch goes by its tension");
  if (const auto differing = difference(model.material, other.material))
    return refused("second: " + other.name + "; must be of the same material as " + model.name + ", but they differ in " +
                   *differing);
  const JointEnd end = find_end(state.cables[first].state, first, first_at_end, state.attachments);
  const JointEnd other_end = find_end(state.cables[second].state, second, second_at_end, state.attachments);
  if (end.next && other_end.next) {
    const auto name = [&](const Attachment& a) { return a.is_junction ? state.bodies[a.holder].name : a.name; };
    const auto place = [&](const Attachment& a) { return (state.frames.poses[a.frame] * a.pose).position; };
    if (end.next->node == end.node && other_end.next->node == other_end.node)
      return refused("first, second: both ends are held, by " + name(*end.next) + " and " + name(*other_end.next) +
                     "; one of them must be an end that nothing holds");
    const double distance = (place(*end.next) - place(*other_end.next)).norm(), length = end.length + other_end.length;
    const bool is_rigid =
        !CableMaterials(state.cables[first]).any_elastic() && !CableMaterials(state.cables[second]).any_elastic();
    if (is_rigid && distance > length * (1 + rounding_of_length))
      return refused("first, second: the ends cannot meet: " + name(*end.next) + " and " + name(*other_end.next) + " are " +
                     rounded_text(distance) + " m apart, the cable between them would be " + rounded_text(length) + " m long");
  }

  // The second cable in the direction of the first.
  if (first_at_end == second_at_end) reverse_cable(second);
  const bool whole = !state.cables[first].state.directors.empty() || !state.cables[second].state.directors.empty();
  for (const int index : {first, second}) {
    std::vector<DirectionTarget>& clamps = state.cable_progress[index].targets.directions;
    if (whole) give_frames(state.cables[index].state, clamps);
    take_end_twists(state.cables[index].state, clamps);
  }
  CableState &kept = state.cables[first].state, &gone = state.cables[second].state;
  const int shift = first_at_end ? kept.nodes() : gone.nodes();
  const std::string name = model.name;
  CableModel joined_model = model;
  take_over_sections(other, joined_model, gone);
  if (first_at_end) {
    append_cable(gone, kept);
  } else {
    CableState joined = gone;
    append_cable(kept, joined);
    joined.reference_node = kept.reference_node + shift;
    joined.reference_orientation = kept.reference_orientation;
    kept = std::move(joined);
  }
  state.cables[first].model = std::make_shared<const CableModel>(std::move(joined_model));
  renumber(first_at_end ? second : first, 0, shift);
  KinematicTargets &targets = state.cable_progress[first].targets, &holders_of_gone = state.cable_progress[second].targets;
  append(holders_of_gone.nodes, targets.nodes);
  append(holders_of_gone.directions, targets.directions);

  LengthDrive drive;
  drive.place = LengthDrive::Place::inside;
  drive.segment = shift - 1;
  const double gap = kept.rest_lengths[drive.segment];
  drive.left = -std::max(gap - approach * state.cables[first].model->segment_length, 0.0);
  drive.speed = joining_speed;
  drive.acceleration = joining_acceleration;
  state.cable_progress[first].drive = drive;

  forget_contacts(second);
  follow_join(first, second);
  state.cables.erase(state.cables.begin() + second);
  state.cable_progress.erase(state.cable_progress.begin() + second);
  const int joined = first > second ? first - 1 : first;
  state.cable_progress[joined].level = 0;
  if (drive.left == 0) {
    close_joint(joined);
  } else {
    after_remeshing(joined);
    SimulatedCable& cable = state.cables[joined];
    project_velocities(*cable.model, boundary_now(state.cable_progress[joined].targets).nodes, cable.state);
  }
  return {true, "", name};
}

/// The second cable has become a part of the first, and those after it count one less.
void World::Implementation::follow_join(int first, int second) {
  const auto follow = [&](int& cable) {
    if (cable == second) cable = first;
    if (cable > second) --cable;
  };
  for (Attachment& a : state.attachments)
    if (a.body.is_cable()) follow(a.body.index);
  for (Load& load : state.loads)
    if (load.body.is_cable()) follow(load.body.index);
  for (Intrusion& intrusion : findings.intrusions) follow(intrusion.cable);
  for (StatusFinding& found : findings.statuses)
    if (found.body.is_cable()) follow(found.body.index);
  for (Excursion& excursion : findings.excursions) follow(excursion.cable);
  for (Break& broken : findings.breaks) {
    follow(broken.cable);
    follow(broken.new_cable);
  }
}

void World::Implementation::reverse_cable(int index) {
  reverse(state.cables[index].state);
  const int n = state.cables[index].state.segments();
  for (Intrusion& intrusion : findings.intrusions)
    if (intrusion.cable == index) intrusion.segment = n - 1 - intrusion.segment;
  for (StatusFinding& found : findings.statuses)
    if (found.body == cable_id(index)) found.node = n - found.node;
  for (Excursion& excursion : findings.excursions)
    if (excursion.cable == index) excursion.node = n - excursion.node - (excursion.kind == Excursion::Kind::tension ? 1 : 0);
  for (Attachment& a : state.attachments) {
    if (a.body != cable_id(index)) continue;
    a.node = n - a.node;
    if (a.guide >= 0) {
      SimulatedGuide& guide = state.guides[a.guide];
      guide.flow = -guide.flow;
      guide.flow_acceleration = -guide.flow_acceleration;
      guide.held_way = -guide.held_way;
      guide.last_way = -guide.last_way;
      guide.sense = -guide.sense;
      if (is_wheel(a)) --a.node;
      std::swap(a.tangent_points[0], a.tangent_points[1]);
      continue;
    }
    if (a.held_junction < 0) a.pose.orientation = a.pose.orientation * turned;
  }
  for (Load& load : state.loads)
    if (load.body == cable_id(index)) load.node = n - load.node;
  for (KinematicTarget& h : state.cable_progress[index].targets.nodes) h.node = n - h.node;
  for (DirectionTarget& h : state.cable_progress[index].targets.directions) {
    h.node = n - h.node;
    h.orientation = h.orientation * turned;
    h.next_orientation = h.next_orientation * turned;
    h.roll = -h.roll;
    std::swap(h.twist_before, h.twist_after);
  }
}

/// The two ends become one node; all segments keep the lengths that they have.
void World::Implementation::close_joint(int index) {
  CableProgress& s = state.cable_progress[index];
  CableState& cable = state.cables[index].state;
  const int node = s.drive->segment, gone = node + 1;
  s.drive.reset();
  std::vector<double> lengths;
  for (int i = 0; i < cable.segments(); ++i)
    if (i != node) lengths.push_back((cable.positions[i + 1] - cable.positions[i]).norm());

  const double mass = cable.masses[node] + cable.masses[gone], part = cable.masses[gone] / mass;
  cable.masses[node] = mass;
  const std::vector<Vector3> apart = cable.positions;
  for (auto* values : {&cable.positions, &cable.velocities, &cable.accelerations})
    (*values)[gone] = (*values)[node] += part * ((*values)[gone] - (*values)[node]);
  carry_frames(apart, cable);
  const double excess = join_rest_shapes(node, cable);
  if (!cable.flexible_fraction.empty())
    cable.flexible_fraction[node] = 0.5 * (cable.flexible_fraction[node] + cable.flexible_fraction[gone]);
  erase_node(gone, cable);
  erase_segment(node, cable);
  if (cable.reference_node >= gone) --cable.reference_node;
  renumber(index, gone, -1);

  std::vector<HeldNode> held;
  for (const KinematicTarget& h : s.targets.nodes) held.push_back({h.node, h.position, h.velocity});
  std::sort(held.begin(), held.end(), [](const HeldNode& a, const HeldNode& b) { return a.node < b.node; });
  const std::vector<Vector3> together = cable.positions;
  for (const HeldNode& h : held) cable.positions[h.node] = h.position;
  project_lengths(held, lengths, cable);
  carry_frames(together, cable);
  after_remeshing(index);
  // Welded as they have come to each other, unless one of them has been cut off meanwhile.
  if (!cable.joint_twist.empty() && node > 0 && node < cable.segments()) {
    cable.rest_twist.resize(cable.nodes(), 0.0);
    cable.rest_twist[node] =
        (joint_angles_at(cable, node).twist - excess) / cable.bending_length(node, joint_length(cable, node));
  }
  project_velocities(*state.cables[index].model, boundary_now(s.targets).nodes, cable);
}

}  // namespace verlet_cable

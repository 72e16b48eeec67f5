#include "edit_requests/checked_pin.h"

#include <algorithm>
#include <cmath>

#include "edit_requests/error_text.h"
#include "verlet_cable/core/body_name.h"
#include "verlet_cable/core/cable_materials.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/pin_rules.h"
#include "verlet_cable/core/quoted_text.h"
#include "verlet_cable/core/scene_fields.h"

namespace verlet_cable {
namespace {

/// The node's place and the cable's direction there, between the directions of its segments.
Pose node_pose(const SimulatedCable& cable, int node) {
  const std::vector<Quaternion> orientations = segment_orientations(cable.state);
  const int last = cable.state.segments() - 1;
  const Quaternion& before = orientations[std::max(node - 1, 0)];
  const Quaternion& after = orientations[std::min(node, last)];
  return {cable.state.positions[node], before.slerp(0.5, after).normalized()};
}

/// What an inextensible cable between the pin and its neighbours cannot do.
void check_reach(const CheckedPin& pin, const World& world, std::vector<std::string>& errors) {
  const SimulatedCable& cable = world.cables()[pin.body.index];
  const CableMaterials materials(cable);
  constexpr double rounding = 1e-6;
  const std::vector<double> arc_length = cable.state.arc_length();
  const Vector3 place = (pin.frame_pose * pin.offset).position;
  for (const Attachment& other : world.attachments()) {
    if (other.body != pin.body) continue;
    if (materials.any_elastic_between(std::min(pin.node, other.node), std::max(pin.node, other.node))) continue;
    const double distance = (place - (world.frame_pose(other.frame) * other.pose).position).norm();
    const double length = std::abs(arc_length[pin.node] - arc_length[other.node]);
    if (distance <= length * (1 + rounding)) continue;
    errors.push_back("offset.position: " + point_text(pin.offset.position) + " in frame " + verlet_cable::in_quotes(pin.frame) +
                     " is " + rounded_text(distance) + " m from " + in_quotes(other.name) + "; allowed: at most the " +
                     rounded_text(length) + " m of cable between them");
  }
}

/// Why a body cannot be held at its frame's origin, too: a clamp holds it alone, and a point is held once.
void check_held_body(const RequestedPin& request, const CheckedPin& pin, const World& world, std::vector<std::string>& errors) {
  constexpr double same_point = 1e-9;  // [m]
  for (const Attachment& other : world.attachments()) {
    if (other.body != pin.body) continue;
    const bool clamped = request.clamp || other.type == AttachmentType::clamp;
    if (!clamped && other.at.position.norm() > same_point) continue;
    errors.push_back(place_text(request.place) + ": " + kind_and_name(world, pin.body) + " is held by " + in_quotes(other.name) +
                     (clamped ? "; allowed: clamps of bodies that nothing else holds, and hinges of those that no clamp holds"
                              : " at its origin already; allowed: bodies that are held elsewhere, or not at all"));
  }
}

void check_held_node(const RequestedPin& request, const CheckedPin& pin, const World& world, std::vector<std::string>& errors) {
  const std::string node =
      place_text(request.place) + ": node " + std::to_string(pin.node) + " of " + kind_and_name(world, pin.body);
  const std::vector<Attachment>& attachments = world.attachments();
  if (const int holder = holder_of(pin.body, pin.node, attachments); holder >= 0) {
    errors.push_back(node + " is held by " + in_quotes(attachments[holder].name) + "; allowed: nodes that nothing holds");
    return;
  }
  if (!pin.body.is_cable()) return;
  const SimulatedCable& cable = world.cables()[pin.body.index];
  if (const NearGuide near = guide_near(pin.body, pin.node, cable, attachments); near.attachment >= 0)
    errors.push_back(node + " is " + rounded_text(near.distance) + " m of cable from guide " +
                     in_quotes(attachments[near.attachment].name) + "; allowed: nodes at least " +
                     rounded_bound_text(guide_room * cable.model->segment_length, 1) + " m from it");
}

/// Of what is to be held.
Pose pose_now(const World& world, const CheckedPin& pin) {
  const auto index = static_cast<std::size_t>(pin.body.index);
  if (pin.body.is_rigid_body()) return world.bodies()[index].pose;
  if (pin.body.is_net()) return {world.nets()[index].state.positions[pin.node], Quaternion::Identity()};
  return node_pose(world.cables()[index], pin.node);
}

}  // namespace

/// Identity for all zeros; otherwise nearly of length one.
Pose read_pose(const std::string& field, const Pose& given, std::vector<std::string>& errors) {
  constexpr double tolerance = 0.01;
  const Vector3& position = given.position;
  if (!(position.cwiseAbs().array() <= coordinate.highest).all())
    errors.push_back(field + ".position: " + point_text(position) + "; allowed: " + coordinate.text("m"));
  const Quaternion& q = given.orientation;
  if ((q.coeffs().array() == 0).all()) return {position, Quaternion::Identity()};
  if (!(std::abs(q.norm() - 1) <= tolerance)) {
    errors.push_back(field + ".orientation: (" + number_text(q.x()) + ", " + number_text(q.y()) + ", " + number_text(q.z()) +
                     ", " + number_text(q.w()) + "); allowed: quaternions of length 1, or all zero for no rotation");
    return {position, Quaternion::Identity()};
  }
  return {position, q.normalized()};
}

CheckedPin check_pin(const RequestedPin& request, const World& world, const FindFrame& find_frame) {
  CheckedPin pin;
  const Location location = locate_node(request.place, world, find_frame);
  pin.errors = location.errors;
  pin.body = location.body;
  pin.node = location.node;
  pin.frame = request.frame_id.empty() ? world.frames().front() : request.frame_id;
  if (!request.keep_offset) pin.offset = read_pose("offset", request.offset, pin.errors);
  if (!request.name.empty() && !is_name(request.name)) {
    pin.errors.push_back("name: " + in_quotes(request.name) + "; allowed: " + name_words + "; or empty");
  }
  if (find(world.attachments(), request.name) >= 0) {
    pin.errors.push_back("name: " + in_quotes(request.name) + "; allowed: names that no attachment has");
  }
  if (const std::optional<Pose> pose = pin.frame[0] == '/' ? std::nullopt : find_frame(pin.frame)) {
    pin.frame_pose = *pose;
  } else {
    pin.errors.push_back("frame_id: " + verlet_cable::in_quotes(pin.frame) +
                         "; allowed: known frames, without a leading /; or empty");
  }
  if (!location.errors.empty()) return pin;
  if (pin.body.is_net() && request.clamp)
    pin.errors.push_back("clamp" + request.place.words->is_true + "; allowed: false, nets are held by hinges");
  if (pin.body.is_rigid_body()) {
    if (pin.frame == world.bodies()[pin.body.index].name)
      pin.errors.push_back("frame_id: " + verlet_cable::in_quotes(pin.frame) + ", the body's own; allowed: others");
    check_held_body(request, pin, world, pin.errors);
  } else {
    check_held_node(request, pin, world, pin.errors);
  }
  if (!pin.errors.empty()) return pin;
  if (request.keep_offset) {
    pin.offset = pin.frame_pose.inverse() * pose_now(world, pin);
  } else if (pin.body.is_cable()) {
    check_reach(pin, world, pin.errors);
    if (!pin.errors.empty()) pin.errors.back() += "; to hold it where it is: keep_offset" + request.place.words->is_true;
  }
  return pin;
}

}  // namespace verlet_cable

#include "interact/handles.h"

#include <algorithm>

#include "publish/conversions.h"
#include "verlet_cable/core/cable_materials.h"

namespace verlet_cable {
namespace {

using visualization_msgs::InteractiveMarker;
using visualization_msgs::InteractiveMarkerControl;
using visualization_msgs::Marker;
using visualization_msgs::MenuEntry;

/// rviz gets slow with more: of larger scenes every second node has a handle, or every third, ...
constexpr std::size_t most_nodes = 200;
/// Wider than what is shown of the cable [radii], so that the mouse finds it. A node's is a cube of the same width: with a sphere
/// at each of two hundred nodes rviz draws a quarter as often.
constexpr double node_size = 1.6, attachment_size = 3.2;
/// Of a cable's length, to each side: 12 pixels or more in a window that shows the whole cable.
constexpr double node_reach = 0.01;
constexpr double largest_arm = 0.3;     // [m]
constexpr double arm_of_cable = 0.12;   // of its length
constexpr double arm_of_net = 3;        // of its first link's length
constexpr double smallest_arm = 10;     // [radii]
constexpr double sphere_in_arm = 0.25;  // a sphere is no larger than this part of the arrows
constexpr double arm_of_body = 1.5;     // of its radius of gyration

void add_menu(const Handle& handle, InteractiveMarker& marker) {
  const auto add = [&](HandleAction action, const char* title) {
    MenuEntry entry;
    entry.id = static_cast<std::uint32_t>(action);
    entry.title = title;
    entry.command_type = MenuEntry::FEEDBACK;
    marker.menu_entries.push_back(entry);
  };
  if (handle.attachment.empty()) {
    add(HandleAction::pin, "Pin here");
  } else {
    add(HandleAction::release, "Release");
  }
  if (!handle.cable.empty() && !handle.is_body) add(HandleAction::cut, "Cut here");
  add(HandleAction::reset, "Reset all");
}

/// An invisible cube: rviz finds it under the mouse all the same, and lights it up there. What is dragged is shown as a pin.
Marker node_shape(const Handle& handle) {
  Marker cube;
  cube.type = Marker::CUBE;
  cube.scale.x = cube.scale.y = cube.scale.z = 2 * handle.half_width;
  return cube;
}

Marker attachment_shape(const Handle& handle) {
  Marker sphere;
  sphere.type = Marker::SPHERE;
  sphere.scale.x = sphere.scale.y = sphere.scale.z =
      2 * std::min(std::max(attachment_size * handle.radius, handle.half_width), sphere_in_arm * handle.arm_length);
  sphere.color.r = sphere.color.g = 1;
  sphere.color.b = 0.3f;
  sphere.color.a = 0.6f;
  return sphere;
}

/// Takes the whole handle, across the view; the wheel brings it nearer.
InteractiveMarkerControl take_control(const Handle& handle) {
  InteractiveMarkerControl control;
  control.name = "take";
  control.orientation.w = 1;
  control.interaction_mode = InteractiveMarkerControl::MOVE_3D;
  control.markers.push_back(handle.attachment.empty() ? node_shape(handle) : attachment_shape(handle));
  control.markers.back().pose.orientation.w = 1;
  return control;
}

/// An arrow or a ring; they lie along the x axis of their orientation, which turns x into the axis.
InteractiveMarkerControl axis_control(const std::string& name, int axis, std::uint8_t mode) {
  const Vector3 part = M_SQRT1_2 * Vector3::Unit(axis);
  InteractiveMarkerControl control;
  control.name = name;
  control.orientation = to_quaternion(axis == 0   ? Quaternion::Identity()
                                      : axis == 1 ? Quaternion(M_SQRT1_2, 0, 0, part.y())
                                                  : Quaternion(M_SQRT1_2, 0, part.z(), 0));
  control.interaction_mode = mode;
  return control;
}

Handle handle_of(const SimulatedCable& cable) {
  Handle handle;
  handle.cable = cable.model->name;
  handle.radius = CableMaterials(cable).largest_radius();
  handle.half_width = std::max(node_size * handle.radius, node_reach * cable.state.length());
  handle.arm_length = std::max(smallest_arm * handle.radius, std::min(arm_of_cable * cable.state.length(), largest_arm));
  return handle;
}

/// Of what holds a net; it has no cable.
Handle handle_of(const SimulatedNet& net) {
  Handle handle;
  handle.arm_length = largest_arm;
  if (!net.model.rest_lengths.empty()) handle.arm_length = std::min(arm_of_net * net.model.rest_lengths.front(), largest_arm);
  handle.radius = handle.arm_length / smallest_arm;
  return handle;
}

/// Of what holds a body.
Handle handle_of(const SimulatedBody& body) {
  Handle handle;
  handle.arm_length = std::min(arm_of_body * radius_of_gyration(body), largest_arm);
  handle.radius = handle.arm_length / smallest_arm;
  return handle;
}

Handle handle_of(const World& world, const BodyId& held) {
  const auto index = static_cast<std::size_t>(held.index);
  if (held.is_rigid_body()) return handle_of(world.bodies()[index]);
  return held.is_net() ? handle_of(world.nets()[index]) : handle_of(world.cables()[index]);
}

void add_attachments(const Simulation& simulation, const std::set<std::string>& grabs, std::vector<Handle>& handles) {
  const World& world = simulation.world();
  for (const Attachment& attachment : world.attachments()) {
    if (!is_named(attachment) || grabs.count(attachment.name) > 0 || !world.frame_known(attachment.frame)) continue;
    Handle handle = handle_of(world, attachment.body);
    handle.name = "attachment/" + attachment.name;
    handle.attachment = attachment.name;
    handle.node = attachment.node;
    handle.turns = attachment.type != AttachmentType::hinge;
    handle.pose = simulation.attachment_pose(attachment);
    if (handle.pose.position.allFinite() && handle.pose.orientation.coeffs().allFinite()) handles.push_back(std::move(handle));
  }
}

void add_nodes(const World& world, const std::set<std::string>& grabs, std::vector<Handle>& handles) {
  std::size_t nodes = 0;
  for (const SimulatedCable& cable : world.cables()) nodes += cable.state.masses.size();
  const int stride = static_cast<int>((nodes + most_nodes - 1) / most_nodes);
  std::set<std::pair<int, int>> held;
  for (const Attachment& attachment : world.attachments())
    if (attachment.body.is_cable() && !attachment.is_junction && grabs.count(attachment.name) == 0)
      held.emplace(attachment.body.index, attachment.node);
  for (int i = 0; i < static_cast<int>(world.cables().size()); ++i) {
    const SimulatedCable& cable = world.cables()[i];
    if (!is_finite(cable)) continue;
    const int last = cable.state.segments();
    for (int node = 0; node <= last; ++node) {
      if ((node % stride != 0 && node != last) || held.count({i, node}) > 0) continue;
      Handle handle = handle_of(cable);
      handle.name = cable.model->name + "/" + std::to_string(node);
      handle.node = node;
      handle.pose.position = cable.state.positions[node];
      handles.push_back(std::move(handle));
    }
  }
}

/// Of bodies that no clamp holds, and that nothing holds there.
void add_bodies(const World& world, const std::set<std::string>& grabs, std::vector<Handle>& handles) {
  constexpr double same_point = 1e-9;  // [m]
  std::set<int> held;
  for (const Attachment& attachment : world.attachments()) {
    if (!attachment.body.is_rigid_body() || grabs.count(attachment.name) > 0) continue;
    if (attachment.type == AttachmentType::clamp || attachment.at.position.norm() <= same_point)
      held.insert(attachment.body.index);
  }
  for (int i = 0; i < static_cast<int>(world.bodies().size()); ++i) {
    const SimulatedBody& body = world.bodies()[i];
    if (body.is_junction || !is_there(world, body) || held.count(i) > 0) continue;
    Handle handle = handle_of(body);
    handle.name = body.name + "/0";
    handle.cable = body.name;
    handle.is_body = true;
    handle.half_width = radius_of_gyration(body);
    handle.pose.position = body.pose.position;
    handles.push_back(std::move(handle));
  }
}

}  // namespace

bool look_alike(const Handle& a, const Handle& b) {
  return a.name == b.name && a.cable == b.cable && a.turns == b.turns && a.radius == b.radius && a.half_width == b.half_width &&
         a.arm_length == b.arm_length;
}

std::vector<Handle> find_handles(const Simulation& simulation, const std::set<std::string>& grabs) {
  std::vector<Handle> handles;
  if (!simulation.started()) return handles;
  add_attachments(simulation, grabs, handles);
  add_bodies(simulation.world(), grabs, handles);
  add_nodes(simulation.world(), grabs, handles);
  return handles;
}

InteractiveMarker interactive_marker(const Handle& handle, const DrawingFrame& frame) {
  InteractiveMarker marker;
  marker.header.frame_id = frame.name;
  marker.name = handle.name;
  marker.pose = frame.pose(handle.pose);
  marker.scale = static_cast<float>(handle.arm_length);
  marker.controls.push_back(take_control(handle));
  add_menu(handle, marker);
  if (handle.attachment.empty()) return marker;
  for (int axis = 0; axis < 3; ++axis) {
    const std::string name(1, "xyz"[axis]);
    marker.controls.push_back(axis_control("move_" + name, axis, InteractiveMarkerControl::MOVE_AXIS));
    if (handle.turns) marker.controls.push_back(axis_control("turn_" + name, axis, InteractiveMarkerControl::ROTATE_AXIS));
  }
  return marker;
}

}  // namespace verlet_cable

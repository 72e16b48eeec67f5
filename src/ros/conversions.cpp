#include "verlet_cable/ros/conversions.h"

#include <algorithm>
#include <cmath>

namespace verlet_cable {

geometry_msgs::Point to_point(const Vector3& vector) {
  geometry_msgs::Point message;
  message.x = vector.x();
  message.y = vector.y();
  message.z = vector.z();
  return message;
}

geometry_msgs::Vector3 to_vector(const Vector3& vector) {
  geometry_msgs::Vector3 message;
  message.x = vector.x();
  message.y = vector.y();
  message.z = vector.z();
  return message;
}

geometry_msgs::Quaternion to_quaternion(const Quaternion& quaternion) {
  geometry_msgs::Quaternion message;
  message.x = quaternion.x();
  message.y = quaternion.y();
  message.z = quaternion.z();
  message.w = quaternion.w();
  return message;
}

geometry_msgs::Pose to_pose(const Pose& pose) {
  geometry_msgs::Pose message;
  message.position = to_point(pose.position);
  message.orientation = to_quaternion(pose.orientation);
  return message;
}

bool is_finite(const SimulatedCable& cable) {
  const auto finite_vector = [](const Vector3& vector) { return vector.allFinite(); };
  const auto finite_number = [](double number) { return std::isfinite(number); };
  const CableState& state = cable.state;
  return std::all_of(state.positions.begin(), state.positions.end(), finite_vector) &&
         std::all_of(state.velocities.begin(), state.velocities.end(), finite_vector) &&
         std::all_of(state.tension.begin(), state.tension.end(), finite_number);
}

Cable to_message(const World& world, int index) {
  const SimulatedCable& cable = world.cables()[index];
  Cable message;
  message.name = cable.model.name;
  for (const Attachment& attachment : world.attachments()) {
    if (attachment.cable != index) continue;
    message.attachments.push_back(attachment.name);
    message.attachment_nodes.push_back(attachment.node);
  }
  message.positions.reserve(cable.model.nodes());
  for (const Vector3& position : cable.state.positions) message.positions.push_back(to_point(position));
  message.velocities.reserve(cable.model.nodes());
  for (const Vector3& velocity : cable.state.velocities) message.velocities.push_back(to_vector(velocity));
  message.orientations.reserve(cable.model.segments());
  for (const Quaternion& orientation : segment_orientations(cable)) message.orientations.push_back(to_quaternion(orientation));
  message.arc_length = cable.model.arc_length();
  message.tension = cable.state.tension;
  message.curvature = node_curvature(cable);
  message.twist = node_twist(cable);
  message.rest_length = cable.model.length();
  message.radius = cable.model.material.radius;
  return message;
}

CableArray to_message(const World& world) {
  CableArray message;
  for (int index = 0; index < static_cast<int>(world.cables().size()); ++index) {
    if (is_finite(world.cables()[index])) message.cables.push_back(to_message(world, index));
  }
  return message;
}

geometry_msgs::Wrench wrench_on_frame(const Attachment& attachment, const Pose& frame) {
  const Quaternion into_frame = frame.orientation.conjugate();
  const Vector3 force = into_frame * attachment.force;
  const Vector3 torque = into_frame * attachment.torque + attachment.pose.position.cross(force);
  geometry_msgs::Wrench message;
  message.force = to_vector(force);
  message.torque = to_vector(torque);
  return message;
}

}  // namespace verlet_cable

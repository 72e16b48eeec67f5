#include "publish/conversions.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "verlet_cable/core/cable_materials.h"

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

bool is_finite(const SimulatedNet& net) {
  const auto all_finite = [](const Vector3& v) { return v.allFinite(); };
  return std::all_of(net.state.positions.begin(), net.state.positions.end(), all_finite) &&
         std::all_of(net.state.velocities.begin(), net.state.velocities.end(), all_finite) &&
         std::all_of(net.state.tension.begin(), net.state.tension.end(), [](double t) { return std::isfinite(t); });
}

bool is_finite(const SimulatedParticle& particle) {
  return particle.position.allFinite() && particle.velocity.allFinite();
}

bool is_there(const World& world, const SimulatedBody& body) {
  return world.frame_known(body.frame) && body.pose.position.allFinite() && body.pose.orientation.coeffs().allFinite() &&
         body.velocity.allFinite() && body.angular_velocity.allFinite();
}

namespace {

Contact to_message(const World& world, const SimulatedContact& contact) {
  Contact message;
  message.segment = contact.segment;
  message.position = to_point(contact.position);
  message.normal = to_vector(contact.normal);
  message.force = to_vector(contact.force);
  message.other = world.touched_name(contact);
  return message;
}

/// All but attachments and contacts.
Cable to_message(const SimulatedCable& cable) {
  Cable message;
  message.name = cable.model->name;
  message.positions.reserve(cable.state.nodes());
  for (const Vector3& position : cable.state.positions) message.positions.push_back(to_point(position));
  message.velocities.reserve(cable.state.nodes());
  for (const Vector3& velocity : cable.state.velocities) message.velocities.push_back(to_vector(velocity));
  message.orientations.reserve(cable.state.segments());
  for (const Quaternion& orientation : segment_orientations(cable.state))
    message.orientations.push_back(to_quaternion(orientation));
  message.arc_length = cable.state.arc_length();
  message.tension = cable.state.tension;
  message.curvature = node_curvature(cable.state);
  message.twist = node_twist(cable.state);
  message.plastic_curvature = plastic_curvature(cable);
  message.rest_length = cable.state.length();
  message.radius = CableMaterials(cable).largest_radius();
  return message;
}

/// `places`: in the message, of each cable; -1: it is left out.
void add_guides(const World& world, const std::vector<int>& places, CableArray& message) {
  std::vector<std::pair<GuideView, int>> views;
  for (std::size_t i = 0; i < world.guides().size(); ++i) {
    const GuideView view = world.view_guide(static_cast<int>(i));
    if (view.cable >= 0 && places[view.cable] >= 0) views.emplace_back(view, static_cast<int>(i));
  }
  // Those that have caught their cable may be anywhere among the others.
  std::stable_sort(views.begin(), views.end(),
                   [](const auto& a, const auto& b) { return a.first.arc_length < b.first.arc_length; });
  for (const auto& [view, guide] : views) {
    Cable& cable = message.cables[places[view.cable]];
    cable.guides.push_back(world.guides()[guide].name);
    cable.guide_arc_length.push_back(view.arc_length);
  }
}

/// In the last step.
std::uint8_t worst_status(const World& world, const BodyId& body) {
  StepResult::Status worst = StepResult::Status::ok;
  for (const StatusFinding& found : world.findings().statuses)
    if (found.body == body) worst = std::max(worst, found.status);
  return static_cast<std::uint8_t>(worst);
}

void add_cables(const World& world, CableArray& message) {
  std::vector<int> places;  // in the message, of each cable; -1: it is left out
  for (const SimulatedCable& cable : world.cables()) {
    places.push_back(is_finite(cable) ? static_cast<int>(message.cables.size()) : -1);
    if (places.back() < 0) continue;
    message.cables.push_back(to_message(cable));
    message.cables.back().status = worst_status(world, cable_id(static_cast<int>(places.size()) - 1));
  }
  for (const Attachment& attachment : world.attachments()) {
    if (!is_named(attachment) || !attachment.body.is_cable() || places[attachment.body.index] < 0) continue;
    Cable& cable = message.cables[places[attachment.body.index]];
    cable.attachments.push_back(attachment.name);
    cable.attachment_nodes.push_back(attachment.node);
  }
  add_guides(world, places, message);
  for (const SimulatedContact& contact : contacts_of_both(world))
    if (places[contact.cable] >= 0) message.cables[places[contact.cable]].contacts.push_back(to_message(world, contact));
}

Net to_message(const SimulatedNet& net) {
  Net message;
  message.name = net.model.name;
  for (const Vector3& position : net.state.positions) message.positions.push_back(to_point(position));
  for (const Vector3& velocity : net.state.velocities) message.velocities.push_back(to_vector(velocity));
  for (const std::array<int, 2>& link : net.model.links)
    for (const int node : link) message.links.push_back(static_cast<std::uint32_t>(node));
  message.tension = net.state.tension;
  return message;
}

Particle to_message(const SimulatedParticle& particle) {
  Particle message;
  message.name = particle.desc.name;
  message.position = to_point(particle.position);
  message.velocity = to_vector(particle.velocity);
  return message;
}

Body to_message(const SimulatedBody& body) {
  Body message;
  message.name = body.name;
  message.pose = to_pose(body.pose);
  message.twist.linear = to_vector(body.velocity);
  message.twist.angular = to_vector(body.angular_velocity);
  return message;
}

}  // namespace

CableArray to_message(const World& world) {
  CableArray message;
  add_cables(world, message);
  for (const SimulatedNet& net : world.nets())
    if (is_finite(net)) message.nets.push_back(to_message(net));
  for (const SimulatedParticle& particle : world.particles())
    if (is_finite(particle)) message.particles.push_back(to_message(particle));
  for (std::size_t i = 0; i < world.bodies().size(); ++i) {
    const SimulatedBody& body = world.bodies()[i];
    if (body.is_junction || !is_there(world, body)) continue;
    message.bodies.push_back(to_message(body));
    message.bodies.back().status = worst_status(world, rigid_body_id(static_cast<int>(i)));
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

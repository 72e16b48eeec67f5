#include "publish/appearance_publisher.h"

#include <boost/make_shared.hpp>
#include <utility>
#include <variant>

#include "publish/color.h"
#include "publish/conversions.h"
#include "publish/net_look.h"
#include "publish/obstacle_markers.h"
#include "publish/queue_size.h"
#include "verlet_cable/core/cable_materials.h"

namespace verlet_cable {
namespace {

void describe(const PlaneShape&, Solid& solid) {
  solid.type = Solid::PLANE;
}

void describe(const SphereShape& sphere, Solid& solid) {
  solid.type = Solid::SPHERE;
  solid.radius = sphere.radius;
}

void describe(const CapsuleShape& capsule, Solid& solid) {
  solid.type = Solid::CAPSULE;
  solid.radius = capsule.radius;
  solid.length = capsule.length;
}

void describe(const CylinderShape& cylinder, Solid& solid) {
  solid.type = Solid::CYLINDER;
  solid.radius = cylinder.radius;
  solid.length = cylinder.length;
}

void describe(const BoxShape& box, Solid& solid) {
  solid.type = Solid::BOX;
  solid.size = to_vector(box.size);
}

void describe(const MeshShape& mesh, Solid& solid) {
  solid.type = Solid::MESH;
  solid.uri = mesh.uri;
  solid.size = to_vector(mesh.scale);
}

Solid solid_of(const Shape& shape, const Pose& pose, const std::string& name, std::uint8_t owner) {
  Solid solid;
  std::visit([&](const auto& of_its_type) { describe(of_its_type, solid); }, shape);
  solid.pose = to_pose(pose);
  solid.name = name;
  solid.owner = owner;
  solid.color = owner == Solid::BODY ? to_color(body_color) : shape_markers(shape, pose).front().color;
  return solid;
}

Look look_of(const SimulatedCable& cable) {
  Look look;
  look.name = cable.model->name;
  look.color = to_color(cable.model->color);
  const CableMaterials materials(cable);
  const int count = materials.vary() ? cable.state.segments() : 1;
  for (int segment = 0; segment < count; ++segment) look.radii.push_back(materials[segment].radius);
  return look;
}

Look look_of(const SimulatedNet& net) {
  Look look;
  look.name = net.model.name;
  look.color = to_color(net.model.color);
  look.radii = {link_width(net.model) / 2};
  for (const std::array<int, 3>& triangle : triangles_of(net.model))
    for (const int node : triangle) look.triangles.push_back(static_cast<std::uint32_t>(node));
  return look;
}

Look look_of(const SimulatedParticle& particle) {
  Look look;
  look.name = particle.desc.name;
  look.color = to_color(particle.desc.color);
  look.radii = {particle.desc.radius};
  return look;
}

void add_bodies(const World& world, Appearance& message) {
  for (const SimulatedBody& body : world.bodies()) {
    if (body.is_junction) continue;
    message.bodies.push_back(body.name);
    if (!is_there(world, body)) continue;
    for (const BodyShape& shape : body.shapes)
      message.solids.push_back(solid_of(shape.shape, body.pose * shape.pose, body.name, Solid::BODY));
  }
}

}  // namespace

AppearancePublisher::AppearancePublisher(ros::NodeHandle& private_node, const SceneDesc& scene)
    : publisher_(private_node.advertise<Appearance>("appearance", publisher_queue_size)) {
  show(scene);
}

void AppearancePublisher::show(const SceneDesc& scene) {
  frame_id_ = scene.frame_id;
  links_.clear();
  if (!scene.robot) return;
  for (const LinkDesc& link : scene.robot->tree)
    for (const ObstacleDesc& obstacle : link.obstacles) links_.insert(obstacle.name);
}

void AppearancePublisher::publish(const World& world, const ros::Time& stamp) {
  if (publisher_.getNumSubscribers() == 0) return;
  const auto message = boost::make_shared<Appearance>();
  message->header.stamp = stamp;
  message->header.frame_id = frame_id_;
  for (const SimulatedCable& cable : world.cables()) message->looks.push_back(look_of(cable));
  for (const SimulatedNet& net : world.nets()) message->looks.push_back(look_of(net));
  for (const SimulatedParticle& particle : world.particles()) message->looks.push_back(look_of(particle));
  add_bodies(world, *message);
  add_obstacles(world, *message);
  publisher_.publish(message);
}

void AppearancePublisher::add_obstacles(const World& world, Appearance& message) const {
  for (const Obstacle& obstacle : world.obstacles()) {
    if (!obstacle.present) continue;
    const Pose pose = world.frame_pose(obstacle.frame) * obstacle.pose;
    const std::uint8_t owner = links_.count(obstacle.name) > 0 ? Solid::LINK : Solid::OBSTACLE;
    message.solids.push_back(solid_of(obstacle.shape, pose, obstacle.name, owner));
  }
}

}  // namespace verlet_cable

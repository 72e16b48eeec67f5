#include "body/make_body.h"

#include "body/mass_properties.h"
#include "verlet_cable/core/scene_desc.h"

namespace verlet_cable {

SimulatedBody make_body(const BodyDesc& desc) {
  const MassProperties properties = *mass_properties(desc);
  SimulatedBody body;
  body.name = desc.name;
  body.mass = properties.mass;
  body.center_of_mass = properties.center_of_mass;
  body.inertia = properties.inertia;
  for (const ShapeDesc& shape : desc.shapes) body.shapes.push_back({pose_of(shape.pose), shape_of(shape)});
  body.friction = desc.friction;
  body.linear_damping = desc.linear_damping;
  body.angular_damping = desc.angular_damping;
  body.fluid = desc.fluid;
  if (desc.pose) body.pose = pose_of(*desc.pose);
  body.velocity = desc.velocity;
  body.angular_velocity = desc.angular_velocity;
  return body;
}

}  // namespace verlet_cable

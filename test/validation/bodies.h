#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "../support/scenes.h"
#include "validation.h"

/// Rigid bodies and the cables that hold them.
namespace verlet_cable::validation {

constexpr double gravity = 9.81;  // [m/s^2]

/// A scene of one material, "rope", without cables.
inline SceneDesc no_cables() {
  SceneDesc scene = scenes::one_cable(1);
  scene.cables.clear();
  return scene;
}

/// [kg], [kg m^2]
inline BodyDesc& add_body(SceneDesc& scene, const std::string& name, double mass, const Vector3& inertia,
                          const InitialPose& pose = {}) {
  BodyDesc& body = scene.bodies.emplace_back();
  body.name = name;
  body.mass = mass;
  body.inertia = inertia;
  body.pose = pose;
  return body;
}

/// Holds a body at a point of its own to a frame, or to another body.
inline BodyAttachmentDesc& hold(BodyDesc& body, AttachmentType type, const Vector3& at, const std::string& other = "",
                                const Vector3& offset = Vector3::Zero()) {
  BodyAttachmentDesc& holder = body.attachments.emplace_back();
  holder.name = body.name + "_holder" + std::to_string(body.attachments.size());
  holder.body = other;
  holder.type = type;
  holder.at = {at.x(), at.y(), at.z(), 0, 0, 0};
  holder.offset = offset;
  return holder;
}

/// An end of a cable on a body; in the fixed frame where `body` is empty.
struct End {
  std::string body;
  Vector3 offset = Vector3::Zero();
  AttachmentType type = AttachmentType::hinge;
  Vector3 rotation = Vector3::Zero();
};

/// A cable that begins along the straight line from `from` to `to`.
inline CableDesc& add_cable(SceneDesc& scene, const std::string& name, double length, int segments, const Vector3& from,
                            const Vector3& to, const End& start, const End& end) {
  CableDesc& cable = scene.cables.emplace_back();
  cable.name = name;
  cable.length = length;
  cable.segments = segments;
  cable.material = "rope";
  cable.initial.type = InitialShapeDesc::Type::points;
  cable.initial.points = {from, to};
  for (const bool at_end : {false, true}) {
    const End& held = at_end ? end : start;
    AttachmentDesc desc = scenes::attachment(name + (at_end ? "_end" : "_start"),
                                             at_end ? PlaceDesc::At::end : PlaceDesc::At::start, held.offset, "", held.type);
    desc.body = held.body;
    desc.rotation = held.rotation;
    cable.attachments.push_back(desc);
  }
  return cable;
}

inline const SimulatedBody& body_of(const Simulation& run, const std::string& name) {
  return run.world.bodies()[find(run.world.bodies(), name)];
}

struct Momenta {
  Vector3 linear = Vector3::Zero(), angular = Vector3::Zero();
};

/// Of bodies, of cables' nodes, and of the spin of cables' segments, whose sections of radius r have r^2 / 2 of polar inertia a
/// mass. Angular momentum about the origin.
inline Momenta momenta_of(const World& world) {
  Momenta sum;
  for (const SimulatedBody& body : world.bodies()) {
    const Eigen::Matrix3d turn = body.pose.orientation.toRotationMatrix();
    const Vector3 momentum = body.mass * body.velocity;
    sum.linear += momentum;
    sum.angular += (body.pose.position + turn * body.center_of_mass).cross(momentum) +
                   turn * (body.inertia * (turn.transpose() * body.angular_velocity));
  }
  for (const SimulatedCable& cable : world.cables()) {
    const CableState& state = cable.state;
    for (int i = 0; i < state.nodes(); ++i) {
      const Vector3 momentum = state.masses[i] * state.velocities[i];
      sum.linear += momentum;
      sum.angular += state.positions[i].cross(momentum);
    }
    const MaterialDesc& material = cable.model->material;
    const double polar_inertia = 0.5 * material.linear_density * material.radius * material.radius;
    for (std::size_t i = 0; i < state.spin.size(); ++i)
      sum.angular +=
          polar_inertia * state.rest_lengths[i] * state.spin[i] * (state.positions[i + 1] - state.positions[i]).normalized();
  }
  return sum;
}

/// Largest deviation of the energy from what it was at first, in parts of the largest kinetic energy on the way.
inline double energy_error(Simulation& run, double duration) {
  const double before = run.world.energy().total();
  double largest = 0, error = 0;
  for (long steps = std::lround(duration / run.world.time_step()); steps > 0 && !testing::Test::HasFatalFailure(); --steps) {
    run.step();
    const Energy energy = run.world.energy();
    largest = std::max(largest, energy.kinetic);
    error = std::max(error, std::abs(energy.total() - before));
  }
  return error / largest;
}

}  // namespace verlet_cable::validation

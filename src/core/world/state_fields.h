#pragma once

#include <tuple>
#include <type_traits>
#include <variant>

#include "verlet_cable/core/contact.h"
#include "world/state.h"

namespace verlet_cable {

/// All fields of a type that a world's state or model is made of, in the order of their declaration. `const Type*` names the
/// type; the object may be constant or not.
/// @{
template <class T>
auto fields(T& x, const Vector3*) {
  return std::tie(x.x(), x.y(), x.z());
}
template <class T>
auto fields(T& x, const Quaternion*) {
  return std::tie(x.x(), x.y(), x.z(), x.w());
}
template <class T>
auto fields(T& x, const Eigen::Matrix3d*) {
  return std::tie(x(0, 0), x(1, 0), x(2, 0), x(0, 1), x(1, 1), x(2, 1), x(0, 2), x(1, 2), x(2, 2));
}
template <class T>
auto fields(T& x, const Pose*) {
  return std::tie(x.position, x.orientation);
}

// Scene
template <class T>
auto fields(T& x, const MaterialDesc*) {
  return std::tie(x.linear_density, x.radius, x.axial_stiffness, x.bending_stiffness, x.torsional_stiffness, x.axial_damping,
                  x.bending_damping, x.torsional_damping, x.drag, x.friction, x.rolling_friction, x.breaking_tension,
                  x.minimum_bend_radius, x.maximum_tension, x.transverse_stiffness, x.maximum_squeeze, x.yield_curvature,
                  x.hardening, x.bending_friction);
}
template <class T>
auto fields(T& x, const NamedMaterial*) {
  return std::tie(x.name, x.material);
}
template <class T>
auto fields(T& x, const PlaceDesc*) {
  return std::tie(x.at, x.arc_length);
}
template <class T>
auto fields(T& x, const AttachmentDesc*) {
  return std::tie(x.name, x.place, x.frame, x.body, x.offset, x.rotation, x.type, x.initial_pose);
}
template <class T>
auto fields(T& x, const PointMassDesc*) {
  return std::tie(x.place, x.mass);
}
template <class T>
auto fields(T& x, const InitialShapeDesc*) {
  return std::tie(x.type, x.from, x.to, x.points, x.velocities);
}
template <class T>
auto fields(T& x, const RestCurvatureDesc*) {
  return std::tie(x.type, x.curvature, x.profile);
}
template <class T>
auto fields(T& x, const SectionDesc*) {
  return std::tie(x.from, x.to, x.material);
}
template <class T>
auto fields(T& x, const CableDesc*) {
  return std::tie(x.name, x.length, x.segments, x.material, x.sections, x.color, x.initial, x.rest_curvature, x.rest_twist,
                  x.stiff_ends, x.attachments, x.point_masses);
}
template <class T>
auto fields(T& x, const GridDesc*) {
  return std::tie(x.rows, x.columns, x.spacing, x.origin, x.x_axis, x.y_axis);
}
template <class T>
auto fields(T& x, const NetAttachmentDesc*) {
  return std::tie(x.name, x.node, x.frame, x.offset, x.initial_pose);
}
template <class T>
auto fields(T& x, const MinimumDistanceDesc*) {
  return std::tie(x.nodes, x.distance);
}
template <class T>
auto fields(T& x, const NetDesc*) {
  return std::tie(x.name, x.grid, x.nodes, x.links, x.mass, x.masses, x.link_type, x.stiffness, x.damping, x.tolerance,
                  x.minimum_distances, x.velocity, x.restitution, x.friction, x.color, x.attachments);
}
template <class T>
auto fields(T& x, const ParticleDesc*) {
  return std::tie(x.name, x.mass, x.position, x.velocity, x.restitution, x.friction, x.radius, x.color);
}
template <class T>
auto fields(T& x, const GravityDesc*) {
  return std::tie(x.type, x.acceleration, x.mu, x.center);
}
template <class T>
auto fields(T& x, const WaveDesc*) {
  return std::tie(x.amplitude, x.period, x.direction, x.phase);
}
template <class T>
auto fields(T& x, const FluidDesc*) {
  return std::tie(x.density, x.velocity, x.surface, x.normal_drag, x.tangential_drag, x.depth, x.waves);
}
template <class T>
auto fields(T& x, const IntegratorDesc*) {
  return std::tie(x.type, x.first_step);
}
template <class T>
auto fields(T& x, const ContactDesc*) {
  return std::tie(x.self, x.between_cables, x.friction);
}
/// What the world itself reads of a link; its obstacles are the world's.
template <class T>
auto fields(T& x, const LinkDesc*) {
  return std::tie(x.name, x.parent, x.fixed);
}
template <class T>
auto fields(T& x, const RobotDesc*) {
  return std::tie(x.tree);
}
/// What the world itself reads: not what only programs do, nor what is made into particles and obstacles at once.
template <class T>
auto fields(T& x, const SceneDesc*) {
  return std::tie(x.time_step, x.jump_speed, x.winch_acceleration, x.numerical_damping, x.tolerance, x.gravity, x.fluid,
                  x.limits.segments, x.materials, x.cables, x.nets, x.integrator, x.robot, x.contact);
}

// Cables
template <class T>
auto fields(T& x, const CableModel*) {
  return std::tie(x.name, x.material, x.material_name, x.section_materials, x.color, x.turns_bodies, x.is_twisted,
                  x.segment_length);
}
template <class T>
auto fields(T& x, const UnresolvedMotion*) {
  return std::tie(x.acceleration_changes, x.turns, x.changed, x.turned, x.known, x.damped);
}
template <class T>
auto fields(T& x, const HalfBend*) {
  return std::tie(x.yielded, x.slipped);
}
template <class T>
auto fields(T& x, const CableState*) {
  return std::tie(x.rest_lengths, x.section_material, x.masses, x.rest_curvature, x.rest_twist, x.flexible_fraction,
                  x.beyond_limits, x.positions, x.velocities, x.accelerations, x.unresolved, x.tension, x.last_tension,
                  x.axial_multiplier, x.yielding, x.taut_energy, x.twist, x.directors, x.spin, x.joint_twist, x.bending_memory,
                  x.reference_node, x.reference_orientation);
}
template <class T>
auto fields(T& x, const SimulatedCable*) {
  return std::tie(x.model, x.state);
}
template <class T>
auto fields(T& x, const KinematicTarget*) {
  return std::tie(x.attachment, x.node, x.position, x.velocity, x.mean_velocity, x.starts, x.gap, x.caught, x.next_position,
                  x.next_velocity, x.frame_velocity, x.average_velocity, x.change, x.left_velocity, x.left_for, x.liveliness,
                  x.jumping_steps, x.jumped_from, x.carried, x.first_excess, x.last_excess, x.least_excess, x.greatest_excess,
                  x.slides, x.lasting_force);
}
template <class T>
auto fields(T& x, const DirectionTarget*) {
  return std::tie(x.attachment, x.node, x.orientation, x.gap, x.caught, x.next_orientation, x.roll, x.twist_before, x.twist_after,
                  x.lasting_torque);
}
template <class T>
auto fields(T& x, const KinematicTargets*) {
  return std::tie(x.nodes, x.directions);
}
template <class T>
auto fields(T& x, const TwistSpan*) {
  return std::tie(x.first_holder, x.last_holder, x.first_node, x.last_node, x.angle, x.origin, x.age);
}
template <class T>
auto fields(T& x, const LengthDrive*) {
  return std::tie(x.place, x.segment, x.left, x.speed, x.acceleration, x.rate, x.tension, x.keeps_tension, x.min_length,
                  x.max_length, x.motor_speed, x.slip, x.debt, x.debt_rate, x.start_length, x.start_masses, x.wound, x.change,
                  x.next_rate, x.next_debt, x.next_debt_rate, x.arrives, x.fastest_in, x.fastest_out, x.carried, x.slipped);
}
template <class T>
auto fields(T& x, const CachedContact*) {
  return std::tie(x.key, x.other_key, x.force, x.normal_force, x.mode, x.inside, x.inside_for);
}
/// No part of the state, but of what is saved with it.
template <class T>
auto fields(T& x, const SimulatedContact*) {
  return std::tie(x.cable, x.segment, x.position, x.normal, x.force, x.obstacle, x.other_cable, x.other_segment, x.body, x.torque,
                  x.length, x.other_length);
}
/// Likewise.
template <class T>
auto fields(T& x, const StatusFinding*) {
  return std::tie(x.body, x.status, x.node, x.max_strain, x.cause);
}
template <class T>
auto fields(T& x, const Intrusion*) {
  return std::tie(x.cable, x.segment, x.obstacle, x.depth);
}
template <class T>
auto fields(T& x, const BodyIntrusion*) {
  return std::tie(x.body, x.obstacle, x.depth);
}
template <class T>
auto fields(T& x, const CableProgress*) {
  return std::tie(x.id, x.targets, x.spans, x.drive, x.contacts, x.level, x.energy);
}

// Nets and particles
template <class T>
auto fields(T& x, const NetModel*) {
  return std::tie(x.name, x.color, x.rows, x.columns, x.link_type, x.stiffness, x.damping, x.tolerance, x.restitution, x.friction,
                  x.masses, x.links, x.rest_lengths, x.minimum_distances);
}
template <class T>
auto fields(T& x, const NetState*) {
  return std::tie(x.positions, x.velocities, x.tension);
}
template <class T>
auto fields(T& x, const SimulatedNet*) {
  return std::tie(x.model, x.state);
}
template <class T>
auto fields(T& x, const PointState::Derivative*) {
  return std::tie(x.velocities, x.accelerations);
}
template <class T>
auto fields(T& x, const PointState*) {
  return std::tie(x.positions, x.velocities, x.accelerations, x.started, x.is_first, x.history, x.known);
}
template <class T>
auto fields(T& x, const LinkMemory*) {
  return std::tie(x.midstep_velocities, x.impulses, x.started);
}
template <class T>
auto fields(T& x, const NetProgress*) {
  return std::tie(x.targets, x.points, x.links);
}
template <class T>
auto fields(T& x, const SimulatedParticle*) {
  return std::tie(x.desc, x.position, x.velocity);
}

// What holds and what is bumped into
template <class T>
auto fields(T& x, const BodyId*) {
  return std::tie(x.kind, x.index);
}
template <class T>
auto fields(T& x, const Attachment*) {
  return std::tie(x.name, x.body, x.node, x.frame, x.holder, x.type, x.pose, x.at, x.force, x.torque, x.guide, x.is_junction,
                  x.held_junction, x.tangent_points);
}
template <class T>
auto fields(T& x, const SimulatedGuide*) {
  return std::tie(x.name, x.type, x.friction, x.radius, x.inertia, x.bearing_friction, x.sense, x.retention, x.capture, x.cable,
                  x.frame, x.pose, x.is_ready, x.flow, x.flow_acceleration, x.lost_length, x.held_energy, x.held_way, x.last_way,
                  x.wheel_energy);
}
template <class T>
auto fields(T&, const PlaneShape*) {
  return std::tie();
}
template <class T>
auto fields(T& x, const SphereShape*) {
  return std::tie(x.radius);
}
template <class T>
auto fields(T& x, const CapsuleShape*) {
  return std::tie(x.radius, x.length);
}
template <class T>
auto fields(T& x, const CylinderShape*) {
  return std::tie(x.radius, x.length);
}
template <class T>
auto fields(T& x, const BoxShape*) {
  return std::tie(x.size);
}
template <class T>
auto fields(T& x, const MeshShape*) {
  return std::tie(x.mesh, x.uri, x.scale, x.sheet, x.thickness);
}
template <class T>
auto fields(T& x, const BodyShape*) {
  return std::tie(x.pose, x.shape);
}
template <class T>
auto fields(T& x, const JointProgress*) {
  return std::tie(x.attachment, x.force, x.torque, x.lasting_force, x.lasting_torque);
}
template <class T>
auto fields(T& x, const BodyProgress*) {
  return std::tie(x.is_placed, x.has_moved, x.acceleration, x.angular_acceleration, x.holders, x.contacts, x.holder_spins,
                  x.joints, x.energy);
}
template <class T>
auto fields(T& x, const BodyFluidDesc*) {
  return std::tie(x.volume, x.center, x.drag_area, x.angular_drag, x.added_mass);
}
template <class T>
auto fields(T& x, const SimulatedBody*) {
  return std::tie(x.name, x.mass, x.center_of_mass, x.inertia, x.shapes, x.is_junction, x.friction, x.linear_damping,
                  x.angular_damping, x.fluid, x.frame, x.pose, x.velocity, x.angular_velocity);
}
template <class T>
auto fields(T& x, const Load*) {
  return std::tie(x.name, x.body, x.node, x.point, x.force, x.torque, x.is_local, x.end_step);
}
template <class T>
auto fields(T& x, const Obstacle*) {
  return std::tie(x.name, x.frame, x.pose, x.shape, x.friction, x.padding, x.holders, x.present, x.id);
}

// World
template <class T>
auto balance_fields(T& part) {
  return std::apply([&](const auto&... field) { return std::tie(part.*field.place...); }, T::fields);
}
template <class T>
auto fields(T& x, const EnergyBalance::Work*) {
  return balance_fields(x);
}
template <class T>
auto fields(T& x, const EnergyBalance::Dissipated*) {
  return balance_fields(x);
}
template <class T>
auto fields(T& x, const EnergyBalance*) {
  return std::tie(x.work, x.dissipated);
}
template <class T>
auto fields(T& x, const Ledger*) {
  return std::tie(x.balance, x.change, x.unaccounted_steps);
}
template <class T>
auto fields(T& x, const Wave*) {
  return std::tie(x.frequency, x.number, x.direction, x.amplitude, x.phase);
}
template <class T>
auto fields(T& x, const Frames*) {
  return std::tie(x.names, x.poses, x.previous_poses, x.earlier_poses, x.known, x.steps_unjudged);
}
template <class T>
auto fields(T& x, const State*) {
  return std::tie(x.scene, x.waves, x.waiting_cables, x.waiting_nets, x.frames, x.steps, x.cables, x.cable_progress, x.nets,
                  x.net_progress, x.particles, x.particle_integrators, x.bodies, x.body_progress, x.attachments, x.guides,
                  x.obstacles, x.loads, x.ledger, x.initial_energy);
}
/// @}

template <class T>
struct IsList : std::false_type {};
template <class T, class Allocator>
struct IsList<std::vector<T, Allocator>> : std::true_type {};
template <class T, std::size_t count>
struct IsList<std::array<T, count>> : std::true_type {};
template <class T, std::size_t count>
struct IsList<T[count]> : std::true_type {};
template <>
struct IsList<BendingStiffness> : std::true_type {};
template <>
struct IsList<std::string> : std::true_type {};
template <class T>
struct IsOptional : std::false_type {};
template <class T>
struct IsOptional<std::optional<T>> : std::true_type {};

/// Calls `visitor` with every number, flag, letter and choice that an object is made of, and with the lengths of its lists and
/// which of its alternatives is there.
template <class Visitor, class T>
void visit(T& x, Visitor&& visitor) {
  using Type = std::remove_const_t<T>;
  if constexpr (std::is_arithmetic_v<Type> || std::is_enum_v<Type>) {
    visitor(x);
  } else if constexpr (std::is_same_v<Type, std::shared_ptr<const SceneDesc>> ||
                       std::is_same_v<Type, std::shared_ptr<const CableModel>>) {
    visit(*x, visitor);
  } else if constexpr (std::is_same_v<Type, std::shared_ptr<const TriangleMesh>>) {
    visit(x->vertices(), visitor);
    visit(x->triangles(), visitor);
  } else if constexpr (std::is_same_v<Type, Shape>) {
    const std::size_t alternative = x.index();
    visitor(alternative);
    std::visit([&](auto& shape) { visit(shape, visitor); }, x);
  } else if constexpr (IsOptional<Type>::value) {
    const bool is_there = x.has_value();
    visitor(is_there);
    if (x) visit(*x, visitor);
  } else if constexpr (IsList<Type>::value) {
    const std::size_t length = std::size(x);
    visitor(length);
    for (auto& element : x) visit(element, visitor);
  } else {
    std::apply([&](auto&... field) { (visit(field, visitor), ...); }, fields(x, static_cast<const Type*>(nullptr)));
  }
}

/// Of all that the future depends on.
std::uint64_t hash(const State& state);

}  // namespace verlet_cable

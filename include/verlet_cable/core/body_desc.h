#pragma once

#include <optional>
#include <string>
#include <vector>

#include "verlet_cable/core/attachment_desc.h"
#include "verlet_cable/core/shape_desc.h"
#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// An attachment of a rigid body.
struct BodyAttachmentDesc {
  std::string name;
  std::string frame;  ///< empty: the fixed frame
  std::string body;   ///< another body that holds it instead of a frame; empty: a frame does
  AttachmentType type = AttachmentType::hinge;
  InitialPose at{};                         ///< pose of the attachment on the body, in its frame
  Vector3 offset = Vector3::Zero();         ///< [m] in the frame that holds it
  Vector3 rotation = Vector3::Zero();       ///< roll, pitch, yaw [rad] in the frame that holds it
  std::optional<InitialPose> initial_pose;  ///< of the frame, until another pose is known
};

/// What the scene's fluid does to a body.
struct BodyFluidDesc {
  double volume = 0;                       ///< [m^3] >= 0, as that of a sphere
  Vector3 center = Vector3::Zero();        ///< [m] of buoyancy, drag and added mass, in the body's frame
  Vector3 drag_area = Vector3::Zero();     ///< [m^2] >= 0, along the body's axes: area times coefficient
  Vector3 angular_drag = Vector3::Zero();  ///< [N m s^2] >= 0, about the body's axes
  Vector3 added_mass = Vector3::Zero();    ///< [kg] >= 0, along the body's axes
};

/// A rigid body: a plug, a hook, a load, a wheel.
struct BodyDesc {
  std::string name;
  double mass = 0;  ///< [kg], > 0
  /// [kg m^2] about the center of mass, about the body's axes; none: that of the shapes with uniform density
  std::optional<Vector3> inertia;
  std::optional<Vector3> center_of_mass;  ///< [m] in the body's frame; none: that of the shapes, or the origin without shapes
  /// At the start. None: where its own clamp or axle holds it; else clamped to the end of the first cable that has a clamp on it;
  /// else with its attachment point at the end of the first cable, parallel to the fixed frame.
  std::optional<InitialPose> pose;
  Vector3 velocity = Vector3::Zero();          ///< [m/s] of the center of mass, fixed frame's axes
  Vector3 angular_velocity = Vector3::Zero();  ///< [rad/s] fixed frame's axes
  std::vector<ShapeDesc> shapes;               ///< no planes; they touch cables and obstacles, not other bodies
  double friction = 0.5;       ///< Coulomb coefficient for cables on it, and for it on obstacles that have none, >= 0
  double linear_damping = 0;   ///< [N s/m] of the center of mass, >= 0
  double angular_damping = 0;  ///< [N m s], >= 0
  BodyFluidDesc fluid;
  std::vector<BodyAttachmentDesc> attachments;
};

}  // namespace verlet_cable

#pragma once

#include <geometry_msgs/Point.h>
#include <geometry_msgs/Pose.h>
#include <geometry_msgs/Quaternion.h>
#include <geometry_msgs/Vector3.h>
#include <geometry_msgs/Wrench.h>
#include <verlet_cable/CableArray.h>

#include "verlet_cable/core/world.h"

namespace verlet_cable {

geometry_msgs::Point to_point(const Vector3& vector);
geometry_msgs::Vector3 to_vector(const Vector3& vector);
geometry_msgs::Quaternion to_quaternion(const Quaternion& quaternion);
geometry_msgs::Pose to_pose(const Pose& pose);

/// Whether every position, velocity and tension of a cable is a finite number: what is not must not leave the node.
bool is_finite(const SimulatedCable& cable);

bool is_finite(const SimulatedNet& net);
bool is_finite(const SimulatedParticle& particle);
/// Whether a body is there already, and all of it finite: one whose holders' frames are not known waits.
bool is_there(const World& world, const SimulatedBody& body);

/// All cables, nets, particles and bodies of a world that are finite. The header is left to the caller.
CableArray to_message(const World& world);

/// What a cable, net or body exerts on the frame that holds it: axes of the frame, torque [N m] about the frame's origin.
/// `frame` is the frame's pose in the fixed frame, in whose axes the attachment's own force and torque are.
geometry_msgs::Wrench wrench_on_frame(const Attachment& attachment, const Pose& frame);

}  // namespace verlet_cable

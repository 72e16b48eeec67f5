#pragma once

#include <geometry_msgs/Pose.h>
#include <geometry_msgs/Wrench.h>
#include <verlet_cable/CableLocation.h>
#include <verlet_cable/Pin.h>

#include <string>

#include "edit_requests/checked_load.h"
#include "edit_requests/checked_pin.h"
#include "edit_requests/location.h"

namespace verlet_cable {

// What messages ask for, unchecked.
RequestedPlace requested_place(const CableLocation& location);
RequestedPin requested_pin(const Pin::Request& request);
Pose requested_pose(const geometry_msgs::Pose& pose);
Vector3 requested_vector(const geometry_msgs::Vector3& vector);
/// Of ApplyWrench.srv and Load.msg. A point of zeros on a node of a cable is none.
RequestedLoad requested_load(const std::string& name, const std::string& frame_id, const geometry_msgs::Point& point,
                             const geometry_msgs::Wrench& wrench, double duration, bool on_body);

/// For the answer: that an arc length was given, and is not used as the mode is another one; empty otherwise.
std::string unused_words(const CableLocation& location);

}  // namespace verlet_cable

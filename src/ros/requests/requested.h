#pragma once

#include <geometry_msgs/Pose.h>
#include <verlet_cable/CableLocation.h>
#include <verlet_cable/Pin.h>

#include <string>

#include "edit_requests/checked_pin.h"
#include "edit_requests/location.h"

namespace verlet_cable {

// What messages ask for, unchecked.
RequestedPlace requested_place(const CableLocation& location);
RequestedPin requested_pin(const Pin::Request& request);
Pose requested_pose(const geometry_msgs::Pose& pose);

/// For the answer: that an arc length was given, and is not used as the mode is another one; empty otherwise.
std::string unused_words(const CableLocation& location);

}  // namespace verlet_cable

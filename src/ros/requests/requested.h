#pragma once

#include <geometry_msgs/Pose.h>
#include <verlet_cable/CableLocation.h>
#include <verlet_cable/Pin.h>

#include "edit_requests/checked_pin.h"
#include "edit_requests/location.h"

namespace verlet_cable {

// What messages ask for, unchecked.
RequestedPlace requested_place(const CableLocation& location);
RequestedPin requested_pin(const Pin::Request& request);
Pose requested_pose(const geometry_msgs::Pose& pose);

}  // namespace verlet_cable

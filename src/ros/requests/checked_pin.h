#pragma once

#include <verlet_cable/Pin.h>

#include <string>
#include <vector>

#include "requests/location.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// A request to pin in terms of the world, or everything that is wrong with it.
struct CheckedPin {
  BodyId body;  ///< a cable, a net or a rigid body
  int node = 0;
  std::string frame;
  Pose frame_pose;  ///< in the fixed frame
  Pose offset;      ///< of the attachment, in the frame
  std::vector<std::string> errors;
};

/// The pose of a request: all zeros for no rotation. What is wrong with it is added to `errors`, with `field` for its name.
Pose read_pose(const std::string& field, const geometry_msgs::Pose& pose, std::vector<std::string>& errors);

CheckedPin check_pin(const Pin::Request& request, const World& world, const FindFrame& find_frame);

}  // namespace verlet_cable

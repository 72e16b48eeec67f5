#pragma once

#include <string>
#include <vector>

#include "edit_requests/location.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// What is to be held, and where, as requests give it. Nothing of it is checked; errors name the fields as Pin.srv does, and
/// those of the place with its words.
struct RequestedPin {
  RequestedPlace place;
  std::string name;          ///< of the attachment; empty: one is made
  std::string frame_id;      ///< empty: the fixed frame
  Pose offset;               ///< in that frame; a quaternion of zeros for no rotation
  bool clamp = false;        ///< holds direction and roll, too
  bool keep_offset = false;  ///< holds it where it is relative to the frame now; `offset` does not count
};

/// A request to pin in terms of the world, or everything that is wrong with it.
struct CheckedPin {
  BodyId body;  ///< a cable, a net or a rigid body
  int node = 0;
  std::string frame;
  Pose frame_pose;  ///< in the fixed frame
  Pose offset;      ///< of the attachment, in the frame
  std::vector<std::string> errors;
};

/// The pose of a request: a quaternion of zeros for no rotation. What is wrong with it is added to `errors`, with `field` for its
/// name.
Pose read_pose(const std::string& field, const Pose& given, std::vector<std::string>& errors);

CheckedPin check_pin(const RequestedPin& request, const World& world, const FindFrame& find_frame);

}  // namespace verlet_cable

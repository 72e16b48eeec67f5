#pragma once

#include <optional>
#include <string>

#include "verlet_cable/core/shape_desc.h"
#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// A place on a cable: its start, its end, or the node nearest to an arc length.
struct PlaceDesc {
  enum class At { start, end, arc_length };
  At at = At::start;
  double arc_length = 0;  ///< [m] from the start, at rest; 0 to the cable's length
};

/// hinge: a point is held; clamp: a whole pose; axle, of bodies only: a point, and the direction of z.
enum class AttachmentType { hinge, clamp, axle };

/// What holds a cable.
struct AttachmentDesc {
  std::string name;
  PlaceDesc place;
  std::string frame;                   ///< empty: the fixed frame
  std::string body;                    ///< instead of a frame; empty: held by a frame
  Vector3 offset = Vector3::Zero();    ///< [m] in the frame or body
  Vector3 rotation = Vector3::Zero();  ///< roll, pitch, yaw [rad] in the frame or body
  AttachmentType type = AttachmentType::hinge;
  std::optional<InitialPose> initial_pose;  ///< where the frame is until anything says otherwise
};

}  // namespace verlet_cable

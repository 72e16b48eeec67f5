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

/// hinge: holds a point; clamp: holds a whole pose; axle, for bodies only: holds a point and the direction of z.
enum class AttachmentType { hinge, clamp, axle };

/// An attachment of a cable.
struct AttachmentDesc {
  std::string name;
  PlaceDesc place;
  std::string frame;                   ///< empty: the fixed frame
  std::string body;                    ///< that holds it instead of a frame; empty: a frame does
  Vector3 offset = Vector3::Zero();    ///< [m] in the frame or body
  Vector3 rotation = Vector3::Zero();  ///< roll, pitch, yaw [rad] in the frame or body
  AttachmentType type = AttachmentType::hinge;
  std::optional<InitialPose> initial_pose;  ///< of the frame, until another pose is known
};

}  // namespace verlet_cable

#pragma once

#include <string>
#include <variant>
#include <vector>

#include "verlet_cable/core/body_id.h"
#include "verlet_cable/core/obstacle.h"
#include "verlet_cable/core/scene_desc.h"
#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// What can be done to a world between its steps.
namespace edit {

/// Holds a node of a cable or, by a hinge, of a net at a pose in a frame. The node goes there smoothly.
struct Pin {
  std::string name;  ///< of the attachment; empty: one is made
  BodyId body;
  int node = 0;
  int frame = 0;  ///< index into World::frames()
  Pose pose;      ///< in the frame; of a net's node the place counts
  AttachmentType type = AttachmentType::hinge;
};

struct Unpin {
  std::string name;
};

/// Gives an attachment another pose in its frame: the next step takes the node there, so move it little by little.
struct MoveAttachment {
  std::string name;
  Pose pose;
};

/// Removes a segment of a cable or a link of a net; those after it count one less. A segment's mass stays on its nodes, and the
/// first piece keeps the name.
struct Cut {
  BodyId body;
  int element = 0;  ///< segment or link
};

/// Pays out or takes in cable at one end, at up to `speed` and smoothly, until the cable is so long; its nodes count anew as
/// segments appear and vanish there. Other attachments and payloads keep their material point.
struct SetLength {
  int cable = 0;
  bool at_end = false;
  double length = 0;  ///< [m]
  double speed = 0;   ///< [m/s]
};

/// Welds two ends of cables of one material. Ends that are apart are drawn together first. The first cable keeps its name and
/// direction.
struct Join {
  int first = 0;
  bool first_at_end = false;
  int second = 0;
  bool second_at_end = false;
};

/// Adds an obstacle, or replaces the one of that name. `holders`, `present` and `id` are the world's to fill in.
struct SetObstacle {
  Obstacle obstacle;
};

struct RemoveObstacle {
  std::string name;
};

}  // namespace edit

using Edit = std::variant<edit::Pin, edit::Unpin, edit::MoveAttachment, edit::Cut, edit::SetLength, edit::Join, edit::SetObstacle,
                          edit::RemoveObstacle>;

/// Outcome of an edit: nothing has changed where `ok` is false, and `message` says why, with names and values.
struct EditResult {
  bool ok = false;
  std::string message;
  std::string name;  ///< pin: of the pin; cut: of the new cable
};

}  // namespace verlet_cable

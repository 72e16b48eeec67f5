#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "verlet_cable/core/body_id.h"
#include "verlet_cable/core/obstacle.h"
#include "verlet_cable/core/scene_desc.h"
#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// Edits of a world, which are applied between its steps.
namespace edit {

/// Holds a node of a cable, or by a hinge a node of a net, at a pose in a frame. The node moves there smoothly.
struct Pin {
  std::string name;  ///< of the attachment; empty: one is generated
  BodyId body;
  int node = 0;
  int frame = 0;  ///< index into World::frames()
  Pose pose;      ///< in the frame; for a node of a net, only the position matters
  AttachmentType type = AttachmentType::hinge;
};

struct Unpin {
  std::string name;
};

/// Gives an attachment another pose in its frame. The next step moves the node there, so make small changes.
struct MoveAttachment {
  std::string name;
  Pose pose;
};

/// Removes a segment of a cable or a link of a net; the indices of later ones decrease by one. The mass of a segment stays on its
/// nodes, and the first piece keeps the name.
struct Cut {
  BodyId body;
  int element = 0;  ///< segment or link
};

/// Pays out or takes in cable at one end, smoothly and at up to `speed`, until the cable has that length. Nodes are renumbered as
/// segments are added or removed there. Other attachments and payloads stay at their material points. Rather than pull more than
/// `max_tension`, the winch stops, or slips and lets cable out, also once it has wound; until it is told something else.
struct SetLength {
  int cable = 0;
  bool at_end = false;
  double length = 0;       ///< [m]
  double speed = 0;        ///< [m/s]
  double max_tension = 0;  ///< [N] 0: none
};

/// Pays out and takes in cable at one end so that it leaves the winch with that tension, until the winch is told something else:
/// a motor that speeds up by the scene's `winch_acceleration`, and runs on, behind a clutch that gives the tension at any speed
/// up to the motor's, either way. Tension 0: a spool that turns freely, and takes nothing in.
struct SetTension {
  int cable = 0;
  bool at_end = false;
  double tension = 0;     ///< [N]
  double max_speed = 0;   ///< [m/s]
  double min_length = 0;  ///< [m] of the whole cable: no more is taken in,
  double max_length = 0;  ///< [m] and no more let out
};

/// Welds two ends of cables of one material. Ends that are apart are first pulled together. The first cable keeps its name and
/// direction.
struct Join {
  int first = 0;
  bool first_at_end = false;
  int second = 0;
  bool second_at_end = false;
};

/// Adds an obstacle, or replaces the one of that name. The world fills in `holders`, `present` and `id`.
struct SetObstacle {
  Obstacle obstacle;
};

struct RemoveObstacle {
  std::string name;
};

/// Applies a load from outside, see Load, or replaces the one of that name; without force and torque it ends it.
struct ApplyLoad {
  std::string name;  ///< of the load; empty: one is generated
  BodyId body;       ///< a cable or a rigid body
  int node = 0;      ///< of a cable
  /// [m] Of a rigid body: where the force acts, in the axes of the body's frame, from its origin; none: its center of mass
  std::optional<Vector3> point;
  Vector3 force = Vector3::Zero();   ///< [N]
  Vector3 torque = Vector3::Zero();  ///< [N m] of a rigid body
  bool is_local = false;             ///< in the axes of the rigid body, with which they turn; else in those of the fixed frame
  double duration = 0;               ///< [s] of which it acts in all steps that begin within it; 0: until it is changed
};

/// Puts things elsewhere, or gives them other velocities, all at once. What is not given stays. Cables' nodes are projected as
/// those that a scene gives: held nodes are where their holders are, and what cannot stretch keeps its length. Cables go with the
/// bodies that hold them.
struct SetState {
  struct OfCable {
    int cable = 0;
    std::optional<std::vector<Vector3>> positions;   ///< [m] one a node
    std::optional<std::vector<Vector3>> velocities;  ///< [m/s] one a node
  };
  /// Of one that nothing but cables holds. What of its velocity its cables do not allow the next step takes away.
  struct OfBody {
    int body = 0;
    std::optional<Pose> pose;                 ///< of its frame
    std::optional<Vector3> velocity;          ///< [m/s] of its center of mass, fixed frame's axes
    std::optional<Vector3> angular_velocity;  ///< [rad/s] fixed frame's axes
  };
  /// Material of its cable goes through the guide, nodes with it.
  struct OfGuide {
    int guide = 0;
    double arc_length = 0;  ///< [m] as GuideView has it
  };
  std::vector<OfCable> cables;
  std::vector<OfBody> bodies;
  std::vector<OfGuide> guides;
};

}  // namespace edit

using Edit = std::variant<edit::Pin, edit::Unpin, edit::MoveAttachment, edit::Cut, edit::SetLength, edit::SetTension, edit::Join,
                          edit::SetObstacle, edit::RemoveObstacle, edit::ApplyLoad, edit::SetState>;

/// Outcome of an edit. If `ok` is false, nothing has changed and `message` says why, with names and values.
struct EditResult {
  bool ok = false;
  std::string message;
  std::string name;  ///< of the new pin or load, or after a cut of the new cable
};

}  // namespace verlet_cable

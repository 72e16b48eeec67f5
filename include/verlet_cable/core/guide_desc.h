#pragma once

#include <optional>
#include <string>

#include "verlet_cable/core/attachment_desc.h"
#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// A guide, through which a cable slides.
struct GuideDesc {
  /// eyelet: the center line passes through a point; sheave: a wheel about z; clip: an eyelet that opens and catches cables
  enum class Type { eyelet, sheave, clip };
  std::string name;
  std::string cable;
  /// The point of the cable that is in it at the start (for a sheave, at the middle of the arc); none: a clip that starts open
  std::optional<PlaceDesc> place;
  std::string frame;                   ///< empty: the fixed frame
  std::string body;                    ///< that holds it instead of a frame; empty: a frame does
  Vector3 offset = Vector3::Zero();    ///< [m] in the frame or body
  Vector3 rotation = Vector3::Zero();  ///< roll, pitch, yaw [rad] in the frame or body
  Type type = Type::eyelet;
  std::optional<double> friction;           ///< Coulomb coefficient, >= 0 or infinite; none: 0, for a sheave infinite
  double radius = 0;                        ///< [m] sheave: to the cable's center line, > 0
  double inertia = 0;                       ///< [kg m^2] sheave: of the wheel, which turns with the cable, >= 0
  double bearing_friction = 0;              ///< [N m] sheave, >= 0
  double retention = infinity;              ///< [N] clip: lets go of a cable that pulls across it by more, > 0
  double capture = 0;                       ///< [m] clip: catches a cable that comes closer, >= 0; 0: never
  std::optional<InitialPose> initial_pose;  ///< of the frame, until another pose is known

  double friction_coefficient() const { return friction ? *friction : type == Type::sheave ? infinity : 0; }
};

}  // namespace verlet_cable

#pragma once

#include <optional>
#include <string>

#include "verlet_cable/core/attachment_desc.h"
#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// What a cable slides through.
struct GuideDesc {
  /// eyelet: the center line passes a point; sheave: a wheel about z; clip: an eyelet that lets go, and catches
  enum class Type { eyelet, sheave, clip };
  std::string name;
  std::string cable;
  /// The material that is in it at first, of a sheave at the middle of the arc; none: a clip that is open at first
  std::optional<PlaceDesc> place;
  std::string frame;                   ///< empty: the fixed frame
  std::string body;                    ///< instead of a frame; empty: held by a frame
  Vector3 offset = Vector3::Zero();    ///< [m] in the frame or body
  Vector3 rotation = Vector3::Zero();  ///< roll, pitch, yaw [rad] in the frame or body
  Type type = Type::eyelet;
  std::optional<double> friction;           ///< Coulomb coefficient, >= 0 or infinite; none: 0, of a sheave infinite
  double radius = 0;                        ///< [m] sheave: to the cable's center line, > 0
  double inertia = 0;                       ///< [kg m^2] sheave: of a wheel that turns with the cable, >= 0
  double bearing_friction = 0;              ///< [N m] sheave, >= 0
  double retention = infinity;              ///< [N] clip: lets go of a cable that is drawn across it by more, > 0
  double capture = 0;                       ///< [m] clip: takes a cable that comes so close, >= 0; 0: never
  std::optional<InitialPose> initial_pose;  ///< where the frame is until anything says otherwise

  double friction_coefficient() const { return friction ? *friction : type == Type::sheave ? infinity : 0; }
};

}  // namespace verlet_cable

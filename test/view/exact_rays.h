#pragma once

#include "verlet_cable/view/camera_model.h"
#include "verlet_cable/view/drawing.h"

namespace verlet_cable::view {

/// Rays in double precision that know nothing of the camera's: they march by the distance to what is nearest, which is that of
/// contact.
class ExactRays {
 public:
  explicit ExactRays(const Drawing& drawing) : drawing_(drawing) {}

  struct Hit {
    int thing = -1;  ///< -1: none
    double depth = 0;
    Vector3 point = Vector3::Zero();
    /// Least distance to anything that was passed by before, over the depth there: how narrowly it missed [1].
    double clearance = infinity;
  };

  /// From `eye`, along a direction whose length is that of the depth 1.
  Hit cast(const Vector3& eye, const Vector3& direction, double near, double far) const;
  /// [m] Signed, to a thing.
  double distance(const Thing& thing, const Vector3& point) const;

 private:
  const Drawing& drawing_;
};

/// The direction of a pixel, z being 1 in the optical frame, without distortion, in the fixed frame.
Vector3 direction_of(const CameraModel& model, const Pose& pose, double u, double v);

}  // namespace verlet_cable::view

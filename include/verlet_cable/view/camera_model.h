#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "verlet_cable/core/types.h"

namespace verlet_cable::view {

constexpr int most_pixels = 16384;  ///< of a side of an image: what x times y still fits into an int

/// What a camera is asked for by its field of view.
struct CameraDesc {
  int width = 640;                     ///< [pixels] 1 to 16384
  int height = 480;                    ///< [pixels] 1 to 16384
  double horizontal_fov = 1.05;        ///< [rad] from the left edge of the image to the right one, without distortion
  std::array<double, 5> distortion{};  ///< as in CameraModel
  double near = 0.1;                   ///< [m] as in CameraModel
  double far = 10;                     ///< [m] as in CameraModel
};

/// A pinhole camera with a lens. Its optical frame has x to the right in the image, y down, and z along the line of sight. The
/// middle of the image's first pixel is at u = v = 0. As in sensor_msgs/CameraInfo with the model plumb_bob.
struct CameraModel {
  int width = 640;                     ///< [pixels] 1 to 16384
  int height = 480;                    ///< [pixels] 1 to 16384
  double fx = 554.0, fy = 554.0;       ///< [pixels] focal lengths, > 0
  double cx = 319.5, cy = 239.5;       ///< [pixels] where the line of sight meets the image
  std::array<double, 5> distortion{};  ///< k1, k2, t1, t2, k3 of plumb_bob
  /// [m] Depths that are measured, 0 < near < far. What is nearer has no depth, and is seen and hides as all else; beyond `far`
  /// nothing is seen.
  double near = 0.1, far = 10;
};

/// All errors, one line each: `horizontal_fov: 3.2; allowed: ...`. Empty: `camera_model` makes one.
std::vector<std::string> validate(const CameraDesc& desc);
/// Likewise. Also where lines of sight of two pixels would cross because of the distortion, which cannot be undone then.
std::vector<std::string> validate(const CameraModel& model);

/// With square pixels, and the line of sight in the middle of the image. `desc` must be valid.
CameraModel camera_model(const CameraDesc& desc);

/// A pose of the optical frame from which a camera at `eye` has `target` in the middle of its image, and `up` upwards in it.
/// Throws std::invalid_argument where there is none: `target` is `eye`, or `up` is along the line of sight.
Pose look_at(const Vector3& eye, const Vector3& target, const Vector3& up);
/// The same with z upwards in the image, or y where the line of sight is along z: as on a map, seen from above.
Pose look_at(const Vector3& eye, const Vector3& target);

/// Pixel of a point in the optical frame. NaN where z <= 0, or so far to the side that the lens' law turns back.
std::array<double, 2> project(const CameraModel& model, const Vector3& point);

/// Lines of sight of all pixels, computed once for many images.
class Lens {
 public:
  /// Throws std::invalid_argument with all that `validate` says.
  explicit Lens(const CameraModel& model);

  const CameraModel& model() const { return model_; }
  /// x and y of the point with z = 1 that is seen in the middle of a pixel, in the optical frame. The point at a depth z [m] is
  /// (z x, z y, z).
  const std::array<double, 2>& sight(int column, int row) const {
    return sights_[static_cast<std::size_t>(row) * static_cast<std::size_t>(model_.width) + static_cast<std::size_t>(column)];
  }

 private:
  CameraModel model_;
  std::vector<std::array<double, 2>> sights_;  ///< row by row
};

}  // namespace verlet_cable::view

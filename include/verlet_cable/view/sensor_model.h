#pragma once

#include <array>
#include <string>
#include <vector>

#include "verlet_cable/view/camera_model.h"

namespace verlet_cable::view {

/// What a depth camera does to depth. All of it is off by default. Colors and masks are not touched.
struct SensorModel {
  /// Standard deviation of what is measured of the depth z: a + b z + c z^2, in m, 1 and 1/m, steps of disparity included: noise
  /// is so much less before it is rounded. Where a step alone has more (its 12^-1/2), that is the deviation. Not below 0 from the
  /// camera's `near` to its `far`.
  std::array<double, 3> axial{};
  double dropout_angle = 90;  ///< [degree] above 0 to 90: no depth where the line of sight is further from the surface's normal
  double baseline = 0;  ///< [m] place of the second imager, or of the projector, along x of the optical frame; 0: none. What that
                        ///< does not see has no depth
  double disparity_step = 0;  ///< [pixels] to which disparities fx baseline / z are rounded; 0: not at all. Needs a baseline
  double edge_dropout = 0;  ///< 0 to 1: how often there is no depth in a pixel beside one that is deeper by more than `edge_step`
  double edge_step = 0.02;  ///< [m]
};

/// All errors, one line each: `noise.axial: [-1, 0, 0]; allowed: ...`. `near`, `far`: [m] as in CameraModel, where they are
/// checked.
std::vector<std::string> validate(const SensorModel& sensor, double near, double far);

/// A depth camera with the figures that are published of it.
struct CameraPreset {
  std::string name;  ///< `realsense_d435`
  CameraDesc camera;
  SensorModel sensor;
  std::string source;  ///< of the figures
};

/// All of them.
const std::vector<CameraPreset>& camera_presets();
/// Null where there is none of that name.
const CameraPreset* find_camera_preset(const std::string& name);

}  // namespace verlet_cable::view

#include <algorithm>
#include <cmath>

#include "verlet_cable/view/sensor_model.h"

namespace verlet_cable::view {
namespace {

double radians(double degrees) {
  return degrees * M_PI / 180;
}

CameraDesc camera(int width, int height, double fov_degrees, double near, double far) {
  CameraDesc desc;
  desc.width = width;
  desc.height = height;
  desc.horizontal_fov = radians(fov_degrees);
  desc.near = near;
  desc.far = far;
  return desc;
}

/// A pair of imagers, whose error of disparity [pixels] is the same at all distances: that of depth is z^2 subpixel / (fx
/// baseline). Depth is that of the left one.
CameraPreset realsense(const std::string& name, const CameraDesc& desc, double baseline, const std::string& least_depth) {
  constexpr double subpixel = 0.08, disparity_step = 1.0 / 32;
  SensorModel sensor;
  sensor.axial = {0, 0, subpixel / (camera_model(desc).fx * baseline)};
  sensor.baseline = baseline;
  sensor.disparity_step = disparity_step;
  return {name, desc, sensor,
          "size, field of view, baseline and noise: Grunnet-Jepsen, Sweetser and Woodfill, Best Known Methods for Tuning Intel "
          "RealSense D400 Depth Cameras, 2018; steps of disparity: Grunnet-Jepsen, Sweetser, Khuong, Tong and Woodfill, "
          "Subpixel Linearity Improvement for Intel RealSense Depth Cameras, 2019; range: Intel, " +
              least_depth};
}

CameraPreset kinect_v1() {
  SensorModel sensor;
  // 0.0012 + 0.0019 (z - 0.4)^2
  sensor.axial = {0.0012 + 0.0019 * 0.4 * 0.4, -2 * 0.0019 * 0.4, 0.0019};
  sensor.dropout_angle = 80;
  sensor.baseline = 0.075;
  sensor.disparity_step = 0.125;
  return {
      "kinect_v1", camera(640, 480, 57, 0.8, 4), sensor,
      "noise and steepest surfaces: Nguyen, Izadi and Lovell, Modeling Kinect Sensor Noise for Improved 3D Reconstruction and "
      "Tracking, 2012, where steps of disparity are part of the noise, as here; baseline: Khoshelham and Elberink, Accuracy and "
      "Resolution of Kinect Depth Data, 2012; steps of disparity: Konolige and Mihelich, Technical "
      "Description of Kinect Calibration, 2010; range and field of view: Microsoft, Kinect for Windows Sensor Components and "
      "Specifications"};
}

}  // namespace

const std::vector<CameraPreset>& camera_presets() {
  static const std::vector<CameraPreset> presets{
      kinect_v1(),
      realsense("realsense_d415", camera(1280, 720, 65, 0.45, 10), 0.055, "data sheet of the D400 series, at this size"),
      realsense("realsense_d435", camera(848, 480, 90, 0.2, 10), 0.05, "specifications of the D435"),
  };
  return presets;
}

const CameraPreset* find_camera_preset(const std::string& name) {
  const auto& presets = camera_presets();
  const auto found =
      std::find_if(presets.begin(), presets.end(), [&](const CameraPreset& preset) { return preset.name == name; });
  return found == presets.end() ? nullptr : &*found;
}

}  // namespace verlet_cable::view

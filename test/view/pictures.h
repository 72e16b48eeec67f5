#pragma once

#include <cstdint>
#include <vector>

#include "verlet_cable/view/render.h"

namespace verlet_cable::view {

/// All images of one look.
struct Picture {
  explicit Picture(const CameraModel& model)
      : width(model.width),
        height(model.height),
        depth(static_cast<std::size_t>(width) * height),
        rgb(3 * depth.size()),
        mask(depth.size()),
        points(3 * depth.size()) {}

  int width, height;
  std::vector<float> depth;
  std::vector<std::uint8_t> rgb;
  std::vector<std::uint16_t> mask;
  std::vector<float> points;

  ImageBuffers buffers() { return {depth.data(), rgb.data(), mask.data(), points.data()}; }
  float depth_at(int column, int row) const { return depth[static_cast<std::size_t>(row) * width + column]; }
  int mask_at(int column, int row) const { return mask[static_cast<std::size_t>(row) * width + column]; }
  /// Whether a pixel and the eight around it show the same.
  bool is_inside(int column, int row) const {
    if (column == 0 || row == 0 || column + 1 == width || row + 1 == height) return false;
    for (int y = row - 1; y <= row + 1; ++y)
      for (int x = column - 1; x <= column + 1; ++x)
        if (mask_at(x, y) != mask_at(column, row)) return false;
    return true;
  }
};

inline Picture picture_of(const Stage& stage, const CameraModel& model, const Pose& pose, const SensorModel& sensor = {},
                          const NoiseSeed& noise = {}) {
  Picture picture(model);
  render(stage, Lens(model), pose, sensor, noise, picture.buffers());
  return picture;
}

inline CameraModel model_of(int width, int height, double horizontal_fov = 1.05) {
  CameraDesc desc;
  desc.width = width;
  desc.height = height;
  desc.horizontal_fov = horizontal_fov;
  return camera_model(desc);
}

inline Thing thing_of(const std::string& name, const Shape& shape, const Pose& pose = {}) {
  Thing thing{name, Thing::Kind::other, {}};
  thing.pose = pose;
  thing.parts.push_back({{}, shape, {}});
  return thing;
}

}  // namespace verlet_cable::view

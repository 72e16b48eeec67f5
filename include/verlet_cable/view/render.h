#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "verlet_cable/view/camera_model.h"
#include "verlet_cable/view/sensor_model.h"
#include "verlet_cable/view/stage.h"

namespace verlet_cable::view {

/// Where the images go, row by row from the top, without gaps; null: not wanted, and not computed.
struct ImageBuffers {
  float* depth = nullptr;         ///< [m] width x height: along z of the optical frame; NaN where there is none
  std::uint8_t* rgb = nullptr;    ///< width x height x 3
  std::uint16_t* mask = nullptr;  ///< width x height: numbers of things, 0 where nothing is seen
  float* points = nullptr;        ///< [m] width x height x 3: x, y, z in the optical frame, of `depth`; NaN where there is none
};

/// Which random numbers an image has: each is a function of these, the pixel and what it is for.
struct NoiseSeed {
  std::uint64_t seed = 0;
  std::uint64_t image = 0;  ///< its number, or its time [ns]: noise of images that differ in it is independent
};

/// What a camera at `pose` (of the optical frame in the fixed one) sees. Rows are shared among the threads of the caller's TBB
/// arena; the same input gives the same bytes on any number of them. Depth is exact to float's precision for tubes and all
/// shapes; Embree only says what is hit first.
void render(const Stage& stage, const Lens& lens, const Pose& pose, const SensorModel& sensor, const NoiseSeed& noise,
            const ImageBuffers& images);

/// Where the nodes of a cable are, and which are seen.
struct CableTruth {
  std::string name;
  std::vector<Vector3> positions;  ///< [m] a node, optical frame
  std::vector<double> u, v;        ///< [pixels] a node, lens distortion included; NaN for what is not in front of the camera
  /// a node: it is in the image, between near and far, and what is first met on the way to it is this cable, no further from the
  /// node than two of its radii there. So a cable is seen up to 30 degrees from its axis: steeper, other parts of it are in
  /// front.
  std::vector<char> visible;
};

/// Of all cables, in their order. Sensors do not matter to it.
std::vector<CableTruth> find_truth(const Stage& stage, const CameraModel& model, const Pose& pose);

}  // namespace verlet_cable::view

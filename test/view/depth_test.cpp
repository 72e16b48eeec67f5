#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "exact_rays.h"
#include "pictures.h"

namespace verlet_cable::view {
namespace {

/// [m] What is asked for is 5e-5. Depths are floats, which at 4 m are 2.4e-7 apart; the exact rays end 1e-9 in front of a
/// surface, which at the most grazing line of sight here (2 degrees) is 3e-8.
constexpr double tolerance = 4e-7;

const Pose from_aside = look_at({1.1, -0.9, 0.7}, {0.02, 0.01, 0.05});

Drawing drawing_with(Thing thing) {
  Drawing drawing;
  drawing.things.push_back(std::move(thing));
  return drawing;
}

/// Where things are seen, and no edge is near: the largest error of depth [m].
double largest_error(const Drawing& drawing, const Pose& pose, int least_pixels) {
  const CameraModel model = model_of(160, 120, 0.6);
  const Picture picture = picture_of(Stage(drawing), model, pose);
  const ExactRays rays(drawing);
  double largest = 0;
  int compared = 0;
  for (int row = 0; row < model.height; ++row)
    for (int column = 0; column < model.width; ++column) {
      if (picture.mask_at(column, row) == 0 || !picture.is_inside(column, row)) continue;
      const auto hit = rays.cast(pose.position, direction_of(model, pose, column, row), model.near, model.far);
      EXPECT_EQ(hit.thing + 1, picture.mask_at(column, row)) << column << " " << row;
      largest = std::max(largest, std::abs(picture.depth_at(column, row) - hit.depth));
      ++compared;
    }
  EXPECT_GT(compared, least_pixels);
  return largest;
}

TEST(Depth, StraightCable) {
  const Drawing drawing = drawing_with(cable("cable", {{{-0.3, 0.05, 0.1}, {0.3, -0.05, 0}}, {0.02}, {}}, {0, 0, 0}));
  EXPECT_LT(largest_error(drawing, from_aside, 250), tolerance);
}

TEST(Depth, BentCableOfTwoRadii) {
  const Tube tube{{{-0.3, 0, 0}, {-0.1, 0.02, 0.1}, {0, 0.05, 0.12}, {0.1, 0, 0}, {0.1, -0.2, 0}}, {0.03, 0.02, 0.02, 0.03}, {}};
  EXPECT_LT(largest_error(drawing_with(cable("cable", tube, {0, 0, 0})), from_aside, 250), tolerance);
}

TEST(Depth, Shapes) {
  const Pose pose{{0.01, 0.02, 0.03}, quaternion_from_rpy({0.3, -0.2, 0.5})};
  for (const Shape& shape : {Shape(SphereShape{0.15}), Shape(BoxShape{{0.3, 0.2, 0.1}}), Shape(CylinderShape{0.1, 0.25}),
                             Shape(CapsuleShape{0.1, 0.2}), Shape(CapsuleShape{0.15, 0})}) {
    SCOPED_TRACE(shape.index());
    EXPECT_LT(largest_error(drawing_with(thing_of("shape", shape, pose)), from_aside, 1000), tolerance);
  }
}

TEST(Depth, PlaneWithThingsOnIt) {
  Drawing drawing = drawing_with(cable("cable", {{{-0.3, 0.05, 0.02}, {0.3, -0.05, 0.02}}, {0.02}, {}}, {0, 0, 0}));
  drawing.things.push_back(thing_of("box", BoxShape{{0.1, 0.1, 0.1}}, {{0, 0.1, 0.05}, Quaternion::Identity()}));
  drawing.things.push_back(thing_of("floor", PlaneShape{}));
  EXPECT_LT(largest_error(drawing, from_aside, 10000), tolerance);
}

TEST(Depth, Mesh) {
  const auto mesh =
      std::make_shared<const TriangleMesh>(std::vector<Vector3>{{0, 0, 0}, {0.4, 0, 0}, {0, 0.4, 0}, {0, 0, 0.4}},
                                           std::vector<TriangleMesh::Triangle>{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}});
  const Pose pose{{0.01, 0.02, 0.03}, quaternion_from_rpy({0.3, -0.2, 0.5})};
  EXPECT_LT(largest_error(drawing_with(thing_of("mesh", MeshShape{mesh}, pose)), from_aside, 1000), tolerance);
}

/// Single precision of places would be off by centimetres there.
TEST(Depth, FarFromTheOrigin) {
  const Vector3 there(4e5, -5e6, 300);
  const Drawing drawing =
      drawing_with(cable("cable", {{Vector3(-0.3, 0.05, 0.1) + there, Vector3(0.3, -0.05, 0) + there}, {0.02}, {}}, {0, 0, 0}));
  const Pose pose{from_aside.position + there, from_aside.orientation};
  // Places themselves are 1e-9 apart there, and the cable's direction is as much off over its radius.
  EXPECT_LT(largest_error(drawing, pose, 250), tolerance + 1e-7);
}

TEST(Depth, PointsLieOnLinesOfSight) {
  const Drawing drawing = drawing_with(thing_of("floor", PlaneShape{}));
  CameraModel model = model_of(64, 48);
  model.distortion = {0.05, -0.02, 0.001, -0.002, 0.003};
  const Picture picture = picture_of(Stage(drawing), model, from_aside);
  for (int row = 0; row < model.height; ++row)
    for (int column = 0; column < model.width; ++column) {
      const float* point = &picture.points[3 * (row * model.width + column)];
      if (std::isnan(point[2])) continue;
      const auto [u, v] = project(model, {point[0], point[1], point[2]});
      EXPECT_NEAR(u, column, 1e-4);
      EXPECT_NEAR(v, row, 1e-4);
      EXPECT_NEAR((from_aside * Pose{{point[0], point[1], point[2]}, Quaternion::Identity()}).position.z(), 0, 1e-6);
    }
}

/// Beyond `far` nothing is seen; what is nearer than `near` is seen, without depth.
TEST(Depth, IsThereFromNearToFar) {
  const Drawing drawing = drawing_with(thing_of("floor", PlaneShape{}));
  CameraModel model = model_of(32, 24);
  const Pose down = look_at({0, 0, 1}, {0, 0, 0}, Vector3::UnitY());
  for (const auto& [near, far, has_depth, is_seen] :
       {std::tuple{0.5, 2.0, true, true}, {0.5, 0.9, false, false}, {1.1, 2.0, false, true}}) {
    model.near = near;
    model.far = far;
    const Picture picture = picture_of(Stage(drawing), model, down);
    EXPECT_EQ(!std::isnan(picture.depth_at(10, 10)), has_depth);
    EXPECT_EQ(!std::isnan(picture.points[3 * (10 * model.width + 10)]), has_depth);
    EXPECT_EQ(picture.mask_at(10, 10), is_seen ? 1 : 0);
  }
}

/// A plate before the right half of the image, 4 cm from the lens, and a wall behind.
Drawing wall_behind_plate() {
  Drawing drawing = drawing_with(cable("cable", {{{-0.3, 0, 1}, {-0.1, 0, 1}, {0.1, 0, 1}, {0.3, 0, 1}}, {0.01}, {}}, {0, 0, 0}));
  drawing.things.push_back(thing_of("plate", BoxShape{{0.1, 0.2, 0.01}}, {{0.05, 0, 0.045}, Quaternion::Identity()}));
  drawing.things.push_back(thing_of("wall", PlaneShape{}, {{0, 0, 2}, quaternion_from_rpy({M_PI, 0, 0})}));
  return drawing;
}

TEST(Depth, WhatIsNearerThanNearHidesWhatIsBehind) {
  const Stage stage(wall_behind_plate());
  CameraModel model = model_of(64, 48);
  model.near = 0.01;
  const Picture all = picture_of(stage, model, {});
  model.near = 0.1;
  SensorModel noisy;
  noisy.axial = {0.01, 0, 0};
  noisy.edge_dropout = 1;
  for (const SensorModel& sensor : {SensorModel{}, noisy}) {
    const Picture picture = picture_of(stage, model, {}, sensor);
    EXPECT_EQ(picture.mask, all.mask);
    EXPECT_EQ(picture.rgb, all.rgb);
    for (int row = 0; row < model.height; ++row)
      for (int column = 0; column < model.width; ++column) {
        if (picture.mask_at(column, row) == 1) continue;
        // Beside the plate, too: that is not deeper.
        const bool is_wall = column < model.width / 2 && (row < 20 || row > 28);
        if (is_wall || column >= model.width / 2) {
          EXPECT_EQ(!std::isnan(picture.depth_at(column, row)), is_wall) << column << " " << row;
        }
      }
  }
  EXPECT_NEAR(all.depth_at(50, 24), 0.04, 1e-6);
  EXPECT_EQ(find_truth(stage, model, {})[0].visible, (std::vector<char>{1, 1, 0, 0}));
}

/// The camera is in its housing, as robots' descriptions have it: a box, or a mesh. That is not seen, and the rest hides as ever.
TEST(Depth, HousingsAreNotSeen) {
  SensorModel sensor;
  sensor.baseline = 0.05;
  const auto mesh = std::make_shared<const TriangleMesh>(
      std::vector<Vector3>{{-0.1, -0.1, -0.1}, {0.3, -0.1, -0.1}, {-0.1, 0.3, -0.1}, {-0.1, -0.1, 0.3}},
      std::vector<TriangleMesh::Triangle>{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}});
  const Drawing bare = wall_behind_plate();
  const CameraModel model = model_of(64, 48);
  const Picture expected = picture_of(Stage(bare), model, {}, sensor);
  for (const Shape& shape : {Shape(BoxShape{{0.2, 0.03, 0.02}}), Shape(MeshShape{mesh})}) {
    Drawing housed = bare;
    housed.things.push_back(thing_of("housing", shape));
    const Stage stage(housed);
    const Picture picture = picture_of(stage, model, {}, sensor);
    EXPECT_EQ(picture.mask, expected.mask);
    for (std::size_t i = 0; i < picture.depth.size(); ++i) {
      EXPECT_EQ(std::isnan(picture.depth[i]), std::isnan(expected.depth[i])) << i;
      if (!std::isnan(expected.depth[i])) {
        EXPECT_NEAR(picture.depth[i], expected.depth[i], 1e-6);
      }
    }
    EXPECT_EQ(find_truth(stage, model, {})[0].visible, (std::vector<char>{1, 1, 0, 0}));
  }
}

}  // namespace
}  // namespace verlet_cable::view

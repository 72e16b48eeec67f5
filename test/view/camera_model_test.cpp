#include "verlet_cable/view/camera_model.h"

#include <gtest/gtest.h>

#include <cmath>

namespace verlet_cable::view {
namespace {

bool begins(const std::string& text, const std::string& start) {
  return text.rfind(start, 0) == 0;
}

TEST(CameraModel, FieldOfViewIsFromEdgeToEdge) {
  CameraDesc desc;
  desc.width = 640;
  desc.height = 480;
  desc.horizontal_fov = 1.2;
  const CameraModel model = camera_model(desc);
  const auto [left, top] = project(model, {-std::tan(0.6), -std::tan(0.6) * 480 / 640, 1});
  EXPECT_NEAR(left, -0.5, 1e-9);
  EXPECT_NEAR(top, -0.5, 1e-9);
  const auto [u, v] = project(model, {0, 0, 3});
  EXPECT_DOUBLE_EQ(u, 319.5);
  EXPECT_DOUBLE_EQ(v, 239.5);
  EXPECT_TRUE(std::isnan(project(model, {0, 0, -1})[0]));
}

/// What image_geometry and OpenCV document for k1, k2, p1, p2, k3.
TEST(CameraModel, DistortionIsThatOfPlumbBob) {
  CameraModel model;
  model.distortion = {0.1, -0.05, 0.002, -0.003, 0.01};
  const double x = 0.3, y = -0.2, rr = x * x + y * y;
  const double radial = 1 + 0.1 * rr - 0.05 * rr * rr + 0.01 * rr * rr * rr;
  const auto [u, v] = project(model, {2 * x, 2 * y, 2});
  EXPECT_NEAR(u, model.cx + model.fx * (x * radial + 2 * 0.002 * x * y - 0.003 * (rr + 2 * x * x)), 1e-9);
  EXPECT_NEAR(v, model.cy + model.fy * (y * radial + 0.002 * (rr + 2 * y * y) + 2 * -0.003 * x * y), 1e-9);
}

TEST(CameraModel, SightsUndoDistortion) {
  CameraModel model;
  model.distortion = {-0.25, 0.08, 0.001, -0.002, -0.01};
  ASSERT_TRUE(validate(model).empty());
  const Lens lens(model);
  for (int row = 0; row < model.height; row += 7)
    for (int column = 0; column < model.width; column += 7) {
      const auto [x, y] = lens.sight(column, row);
      const auto [u, v] = project(model, {x, y, 1});
      EXPECT_NEAR(u, column, 1e-8);
      EXPECT_NEAR(v, row, 1e-8);
    }
}

TEST(CameraModel, DistortionThatFoldsTheImageIsRefused) {
  CameraDesc desc;
  desc.horizontal_fov = 1.6;
  desc.distortion = {-0.5, 0, 0, 0, 0};
  const std::vector<std::string> errors = validate(desc);
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_TRUE(begins(errors[0], "distortion: [-0.5, 0, 0, 0, 0]; allowed: ")) << errors[0];
  EXPECT_THROW(Lens{camera_model(desc)}, std::invalid_argument);
  // Further out the law turns back: what is there is not seen in the middle of the image.
  CameraModel model;
  model.distortion = {-0.2, 0, 0, 0, 0};
  ASSERT_TRUE(validate(model).empty());
  EXPECT_TRUE(std::isnan(project(model, {2.2, 0, 1})[0]));
}

TEST(CameraModel, ErrorsAreNamedAllAtOnce) {
  CameraDesc desc;
  desc.width = 0;
  desc.height = 20000;
  desc.horizontal_fov = M_PI;
  desc.near = 2;
  desc.far = 1;
  desc.distortion = {0, NAN, 0, 0, 0};
  const std::vector<std::string> errors = validate(desc);
  ASSERT_EQ(errors.size(), 5u);
  EXPECT_EQ(errors[0], "width: 0; allowed: an integer [pixels] (from 1 to 16384)");
  EXPECT_EQ(errors[1], "height: 20000; allowed: an integer [pixels] (from 1 to 16384)");
  EXPECT_TRUE(begins(errors[2], "distortion: [0, nan, 0, 0, 0]; allowed: five numbers")) << errors[2];
  EXPECT_EQ(errors[3], "far: 1; allowed: any number above near, 2 [m]");
  EXPECT_TRUE(begins(errors[4], "horizontal_fov: 3.14159")) << errors[4];
  CameraModel model;
  model.fx = 0;
  model.cy = INFINITY;
  EXPECT_EQ(validate(model).size(), 2u);
}

TEST(CameraModel, LooksAtItsTarget) {
  const Vector3 eye(1, 2, 3), target(-0.5, 0.2, 0.1);
  const Pose pose = look_at(eye, target);
  EXPECT_EQ(pose.position, eye);
  const Pose inside = pose.inverse() * Pose{target, Quaternion::Identity()};
  EXPECT_NEAR(inside.position.x(), 0, 1e-12);
  EXPECT_NEAR(inside.position.y(), 0, 1e-12);
  EXPECT_NEAR(inside.position.z(), (target - eye).norm(), 1e-12);
  const Vector3 up = pose.orientation.conjugate() * Vector3::UnitZ();
  EXPECT_NEAR(up.x(), 0, 1e-12);
  EXPECT_LT(up.y(), 0);  // in the image, y is down
  EXPECT_THROW(look_at(eye, eye), std::invalid_argument);
  EXPECT_THROW(look_at(eye, {NAN, 0, 0}), std::invalid_argument);
}

/// From straight above the image is as a map: x to the right, y upwards.
TEST(CameraModel, LooksStraightDown) {
  const Vector3 eye(1, 2, 3);
  const Pose down = look_at(eye, eye - Vector3(0, 0, 2));
  EXPECT_LT((down.orientation * Vector3::UnitX() - Vector3::UnitX()).norm(), 1e-12);
  EXPECT_LT((down.orientation * Vector3::UnitY() + Vector3::UnitY()).norm(), 1e-12);
  const Pose up = look_at(eye, eye + Vector3(0, 0, 2));
  EXPECT_LT((up.orientation * Vector3::UnitY() + Vector3::UnitY()).norm(), 1e-12);
  try {
    look_at(eye, eye - Vector3(0, 0, 2), Vector3::UnitZ());
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "up: [0, 0, 1], along the line of sight, or without length; allowed: any other direction, such as [0, 1, 0] for "
                 "what is seen from above");
  }
}

}  // namespace
}  // namespace verlet_cable::view

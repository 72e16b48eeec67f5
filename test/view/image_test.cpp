#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <cmath>

#include "../support/meshes.h"
#include "pictures.h"

namespace verlet_cable::view {
namespace {

const Pose from_aside = look_at({0.8, -0.9, 0.6}, {0, 0, 0.1});

/// Some of everything.
Drawing table() {
  Drawing drawing;
  Tube tube{{}, {0.01}, {}};
  for (int k = 0; k <= 30; ++k) tube.centers.emplace_back(-0.3 + 0.02 * k, 0.05 * std::sin(0.5 * k), 0.06);
  for (int k = 0; k < 30; ++k)
    tube.orientations.push_back(Quaternion::FromTwoVectors(Vector3::UnitX(), tube.centers[k + 1] - tube.centers[k]) *
                                quaternion_from_rpy({0.2 * k, 0, 0}));
  drawing.things.push_back(cable("hose", tube, {0.8, 0.1, 0.1}));
  Thing plug{"plug", Thing::Kind::body, body_look()};
  plug.parts.push_back({{{0.3, 0, 0.06}, Quaternion::Identity()}, CylinderShape{0.02, 0.08}, {}});
  plug.parts.push_back({{{0.3, 0, 0.15}, Quaternion::Identity()}, SphereShape{0.02}, {}});
  drawing.things.push_back(plug);
  drawing.things.push_back(
      thing_of("ring", MeshShape{torus_triangles(0.1, 0.03, 24, 12).mesh()}, {{0, 0.2, 0.03}, Quaternion::Identity()}));
  drawing.things.push_back(thing_of("floor", PlaneShape{}));
  drawing.things.back().look = plane_look();
  return drawing;
}

SensorModel some_sensor() {
  SensorModel sensor;
  sensor.axial = {0.001, 0, 0.002};
  sensor.dropout_angle = 80;
  sensor.baseline = 0.05;
  sensor.edge_dropout = 0.5;
  return sensor;
}

void expect_same_bytes(const Picture& one, const Picture& other) {
  const auto are_same = [](const auto& a, const auto& b) {
    return std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0;
  };
  EXPECT_TRUE(are_same(one.depth, other.depth));
  EXPECT_TRUE(are_same(one.rgb, other.rgb));
  EXPECT_TRUE(are_same(one.mask, other.mask));
  EXPECT_TRUE(are_same(one.points, other.points));
}

TEST(Image, SameBytesOnOneThreadAndTwo) {
  const Stage stage(table());
  const CameraModel model = model_of(203, 101);  // neither is a multiple of what is followed together
  const auto on_threads = [&](int threads) {
    Picture picture(model);
    tbb::task_arena arena(threads);
    arena.execute([&] { picture = picture_of(stage, model, from_aside, some_sensor(), {3, 4}); });
    return picture;
  };
  const Picture one = on_threads(1);
  expect_same_bytes(one, on_threads(2));
  // Nor do they depend on where memory is, or on what was seen before.
  const Stage other(table(), &stage);
  expect_same_bytes(one, picture_of(other, model, from_aside, some_sensor(), {3, 4}));
}

TEST(Image, EachImageAloneHasTheBytesOfAllTogether) {
  const Stage stage(table());
  const CameraModel model = model_of(64, 50);
  const Lens lens(model);
  const Picture all = picture_of(stage, model, from_aside, some_sensor());
  Picture each(model);
  const auto only = [&](const ImageBuffers& images) { render(stage, lens, from_aside, some_sensor(), {}, images); };
  only({each.depth.data(), nullptr, nullptr, nullptr});
  only({nullptr, each.rgb.data(), nullptr, nullptr});
  only({nullptr, nullptr, each.mask.data(), nullptr});
  only({nullptr, nullptr, nullptr, each.points.data()});
  expect_same_bytes(all, each);
}

/// The colors of the pixels of a thing, in the mean.
Vector3 mean_color(const Picture& picture, int number) {
  Vector3 sum = Vector3::Zero();
  int count = 0;
  for (std::size_t i = 0; i < picture.mask.size(); ++i)
    if (picture.mask[i] == number) ++count, sum += Vector3(picture.rgb[3 * i], picture.rgb[3 * i + 1], picture.rgb[3 * i + 2]);
  return sum / count;
}

TEST(Image, ThingsHaveTheirColors) {
  Drawing drawing = table();
  drawing.things[0].look.pattern = Look::Pattern::plain;
  const Picture picture = picture_of(Stage(drawing), model_of(160, 120), from_aside);
  const Vector3 hose = mean_color(picture, 1), plug = mean_color(picture, 2);
  EXPECT_GT(hose.x(), 3 * hose.y());
  EXPECT_GT(plug.x(), 1.2 * plug.z());
  drawing.background = {0, 0, 1};
  const Picture up = picture_of(Stage(drawing), model_of(8, 8), look_at({0, 0, 1}, {0.1, 0, 2}));
  EXPECT_EQ(mean_color(up, 0), Vector3(0, 0, 255));
}

TEST(Image, ShadowsAreDark) {
  Drawing drawing = table();
  drawing.things.back().look.pattern = Look::Pattern::plain;
  const CameraModel model = model_of(160, 120);
  const Vector3 with = mean_color(picture_of(Stage(drawing), model, from_aside), 4);
  drawing.light.shadows = false;
  EXPECT_LT(with.sum() + 0.5, mean_color(picture_of(Stage(drawing), model, from_aside), 4).sum());
}

/// A stripe on the far side of a cable comes to the front as the cable rolls by half a turn.
TEST(Image, StripesShowRoll) {
  const CameraModel model = model_of(64, 48, 0.3);
  const auto brightness = [&](double roll) {
    const Quaternion turned = quaternion_from_rpy({roll, 0, 0});
    Drawing drawing;
    drawing.things.push_back(cable("cable", {{{-1, 0, 0}, {0, 0, 0}, {1, 0, 0}}, {0.05}, {turned, turned}}, {0.1, 0.1, 0.1}));
    return mean_color(picture_of(Stage(drawing), model, look_at({0, 1, 0}, {0, 0, 0})), 1).sum();
  };
  EXPECT_GT(brightness(0), 1.3 * brightness(M_PI));
  EXPECT_NEAR(brightness(0), brightness(2 * M_PI), 1e-6);
}

/// Between a segment and the next that is turned by 1 rad, the stripe goes on without a jump.
TEST(Image, StripesGoOnFromSegmentToSegment) {
  Drawing drawing;
  drawing.things.push_back(cable(
      "cable", {{{-1, 0, 0}, {0, 0, 0}, {1, 0, 0}}, {0.2}, {quaternion_from_rpy({-0.5, 0, 0}), quaternion_from_rpy({0.5, 0, 0})}},
      {0.1, 0.1, 0.1}));
  drawing.light.ambient = 1;
  const CameraModel model = model_of(101, 101, 0.5);
  const Picture picture = picture_of(Stage(drawing), model, look_at({0, 1, 0}, {0, 0, 0}));
  const auto middle_of_stripe = [&](int column) {
    double sum = 0, count = 0;
    for (int row = 0; row < model.height; ++row)
      if (picture.mask_at(column, row) == 1 && picture.rgb[3 * (row * model.width + column)] > 120) sum += row, ++count;
    return sum / count;
  };
  for (int column = 1; column < model.width; ++column) EXPECT_NEAR(middle_of_stripe(column), middle_of_stripe(column - 1), 1.5);
  EXPECT_NEAR(middle_of_stripe(50), 50, 1.5);
}

}  // namespace
}  // namespace verlet_cable::view

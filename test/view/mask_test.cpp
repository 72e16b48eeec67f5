#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "exact_rays.h"
#include "pictures.h"

namespace verlet_cable::view {
namespace {

/// Some way through the air, without sharp bends.
Tube wandering(std::mt19937& random, const Vector3& start, double radius) {
  std::normal_distribution<double> normal;
  const auto vector = [&] { return Vector3(normal(random), normal(random), normal(random)); };
  Tube tube{{start}, {radius}, {}};
  Vector3 direction = vector().normalized();
  for (int k = 0; k < 40; ++k) {
    direction = (direction + 0.3 * vector()).normalized();
    tube.centers.push_back(tube.centers.back() + 0.02 * direction);
  }
  return tube;
}

Drawing crowd(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(-0.25, 0.25);
  Drawing drawing;
  for (int k = 0; k < 8; ++k) {
    const Vector3 start(place(random), place(random), 0.3 + place(random));
    drawing.things.push_back(cable("cable " + std::to_string(k), wandering(random, start, 0.004 + 0.001 * k), {0.2, 0.2, 0.2}));
  }
  drawing.things.push_back(thing_of("box", BoxShape{{0.2, 0.1, 0.1}}, {{0.1, -0.1, 0.2}, quaternion_from_rpy({0.1, 0.2, 0.3})}));
  drawing.things.push_back(thing_of("ball", SphereShape{0.08}, {{-0.2, 0, 0.3}, Quaternion::Identity()}));
  drawing.things.push_back(thing_of("floor", PlaneShape{}));
  return drawing;
}

const Pose before = look_at({0.1, -1.2, 0.6}, {0, 0, 0.2});

/// Every pixel shows what the ray through its middle meets, which is less than a pixel at every edge; but where the ray just
/// misses something by what single precision cannot tell.
TEST(Mask, OutlinesAreExact) {
  const CameraModel model = model_of(120, 90, 0.7);
  for (const unsigned seed : {1u, 2u}) {
    const Drawing drawing = crowd(seed);
    const Picture picture = picture_of(Stage(drawing), model, before);
    const ExactRays rays(drawing);
    int cables = 0;
    for (int row = 0; row < model.height; ++row)
      for (int column = 0; column < model.width; ++column) {
        const auto hit = rays.cast(before.position, direction_of(model, before, column, row), model.near, model.far);
        cables += hit.thing >= 0 && hit.thing < 8;
        if (hit.thing + 1 == picture.mask_at(column, row)) continue;
        // A hundredth of a pixel.
        EXPECT_LT(hit.clearance * model.fx, 0.01) << column << " " << row << " shows " << picture.mask_at(column, row);
      }
    EXPECT_GT(cables, 500);
  }
}

/// The outline of a sphere on the line of sight is a circle; that of a cable, from far away, a strip.
TEST(Mask, OutlinesHaveClosedForms) {
  const CameraModel model = model_of(321, 241, 0.8);
  const double distance = 0.9, radius = 0.1;
  Drawing drawing;
  drawing.things.push_back(thing_of("ball", SphereShape{radius}, {{0, 0, distance}, Quaternion::Identity()}));
  const double outline = model.fx * radius / std::sqrt(distance * distance - radius * radius);
  const Picture picture = picture_of(Stage(drawing), model, {});
  for (int row = 0; row < model.height; ++row)
    for (int column = 0; column < model.width; ++column) {
      const double away = std::hypot(column - model.cx, row - model.cy);
      if (std::abs(away - outline) > 1e-3) {
        EXPECT_EQ(picture.mask_at(column, row), away < outline) << column << " " << row;
      }
    }
}

TEST(Mask, NumbersAreOfTheOrderOfTheLabels) {
  const Drawing drawing = crowd(1);
  const std::vector<std::string> names = labels(drawing);
  ASSERT_EQ(names.size(), 11u);
  EXPECT_EQ(names[7], "cable 7");
  EXPECT_EQ(names[10], "floor");
  const Picture picture = picture_of(Stage(drawing), model_of(64, 48), before);
  EXPECT_EQ(picture.mask_at(32, 47), 11);
}

TEST(Truth, VisibilityIsThatOfExactRays) {
  const CameraModel model = model_of(320, 240, 0.7);
  int nodes = 0, seen = 0, wrong = 0;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const Drawing drawing = crowd(seed);
    const ExactRays rays(drawing);
    const std::vector<CableTruth> truth = find_truth(Stage(drawing), model, before);
    ASSERT_EQ(truth.size(), 8u);
    for (std::size_t k = 0; k < truth.size(); ++k) {
      const Tube& tube = drawing.things[k].tubes.front();
      ASSERT_EQ(truth[k].visible.size(), tube.centers.size());
      for (std::size_t node = 0; node < tube.centers.size(); ++node) {
        const Vector3 place = (before.inverse() * Pose{tube.centers[node], Quaternion::Identity()}).position;
        EXPECT_LT((place - truth[k].positions[node]).norm(), 1e-12);
        const double u = model.fx * place.x() / place.z() + model.cx, v = model.fy * place.y() / place.z() + model.cy;
        EXPECT_NEAR(truth[k].u[node], u, 1e-9);
        EXPECT_NEAR(truth[k].v[node], v, 1e-9);
        bool is_visible = u >= -0.5 && u < model.width - 0.5 && v >= -0.5 && v < model.height - 0.5;
        if (is_visible) {
          const auto hit = rays.cast(before.position, direction_of(model, before, u, v), model.near, model.far);
          is_visible = hit.thing == static_cast<int>(k) && (hit.point - tube.centers[node]).norm() <= 2 * tube.radii.front();
        }
        ++nodes;
        seen += is_visible;
        wrong += is_visible != static_cast<bool>(truth[k].visible[node]);
      }
    }
  }
  EXPECT_GT(seen, nodes / 4);
  EXPECT_LT(seen, nodes * 9 / 10);
  RecordProperty("wrong", wrong);
  EXPECT_LE(wrong, nodes * 0.005);
}

TEST(Truth, WhatIsNotInTheImageIsNotVisible) {
  Drawing drawing;
  drawing.things.push_back(cable("cable", {{{-3, 0.3, -1}, {-0.3, 0.3, 1}, {3, 0.3, 1}}, {0.01}, {}}, {0, 0, 0}));
  const std::vector<CableTruth> truth = find_truth(Stage(drawing), model_of(64, 64, 1), {});
  EXPECT_TRUE(std::isnan(truth[0].u[0]));
  EXPECT_EQ(truth[0].visible, (std::vector<char>{0, 1, 0}));
  EXPECT_GT(truth[0].u[2], 64);
}

/// Seen nearly along its axis, what is in front of a node is another part of the cable.
TEST(Truth, CablesAreSeenUpTo30DegreesFromTheirAxis) {
  for (const auto& [degrees, is_seen] : {std::pair{29.0, false}, {31.0, true}}) {
    const double angle = degrees * M_PI / 180;
    const Vector3 along(std::sin(angle), 0, std::cos(angle)), middle(0, 0, 1);
    Drawing drawing;
    drawing.things.push_back(cable("cable", {{middle - 0.1 * along, middle, middle + 0.1 * along}, {0.01}, {}}, {0, 0, 0}));
    EXPECT_EQ(find_truth(Stage(drawing), model_of(64, 64, 1), {})[0].visible[1], is_seen) << degrees;
  }
}

}  // namespace
}  // namespace verlet_cable::view

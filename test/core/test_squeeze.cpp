#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "../support/nets.h"
#include "../support/scenes.h"
#include "contact/law.h"
#include "contact/pressed_lengths.h"
#include "verlet_cable/core/excursion_text.h"
#include "verlet_cable/core/world.h"

// Soft sections: forces of contacts are the transverse stiffness times what is squeezed, and can be read and limited.

namespace verlet_cable {
namespace {

constexpr double radius = 0.005, stiffness = 1e5;

ObstacleDesc box(const std::string& name, const Vector3& place, const Vector3& size, const std::string& frame = "") {
  ObstacleDesc desc;
  desc.name = name;
  desc.frame = frame;
  desc.type = ShapeType::box;
  desc.size = size;
  desc.pose = {place.x(), place.y(), place.z(), 0, 0, 0};
  return desc;
}

/// A soft rope along x between two faces that are closer to each other than its diameter, without weight.
SceneDesc between_jaws(int segments, double first, double last, double compression) {
  SceneDesc scene = scenes::one_cable(segments);
  scene.materials[0].material.transverse_stiffness = stiffness;
  scene.gravity.acceleration.setZero();
  scene.cables[0].initial.type = InitialShapeDesc::Type::straight;
  const double width = last - first, y = 0.01 + radius - 0.5 * compression;
  for (const double side : {1.0, -1.0})
    scene.obstacles.push_back(box(side > 0 ? "left" : "right", {0.5 * (first + last), side * y, 0}, {width, 0.02, 0.04}));
  return scene;
}

TEST(Squeeze, LawIsThatOfHalfASectionUntilItIsFlat) {
  Touch touch;
  touch.radius = radius;
  touch.base_stiffness = 100;
  soften(2000, touch);
  EXPECT_DOUBLE_EQ(force_of_depth(0.5 * radius, touch), 2000 * 0.5 * radius);
  EXPECT_DOUBLE_EQ(force_of_depth(0.8 * radius, touch), 2000 * 0.8 * radius);
  EXPECT_GT(force_of_depth(0.9 * radius, touch), 2000 * 0.9 * radius + 10);
  touch.yields = true;
  EXPECT_LT(force_of_depth(0.5 * radius, touch), 100 * 0.5 * radius * 1.01);
}

TEST(Squeeze, JawsFeelStiffnessTimesCompressionTimesWidthWhereverNodesAre) {
  for (const int segments : {10, 33, 50, 200})
    for (const double shift : {0.0, 0.3, 0.5, 0.9})
      for (const double width : {0.02, 0.05, 0.13}) {
        const double first = 0.4 + shift / segments, compression = 0.2 * radius;
        const SceneDesc scene = between_jaws(segments, first, first + width, compression);
        World world(scene, initial_frames(scene));
        scenes::run(world, 100);
        for (const double side : {1.0, -1.0}) {
          const ContactWrench wrench = world.contact_wrench(side > 0 ? "left" : "right");
          EXPECT_NEAR(side * wrench.force.y(), stiffness * compression * width, 1e-3 * stiffness * compression * width)
              << segments << ' ' << shift << ' ' << width;
        }
        double length = 0;
        for (const SimulatedContact& contact : world.findings().contacts) length += contact.length;
        EXPECT_NEAR(length, 2 * width, 1e-6);
      }
}

TEST(Squeeze, SectionsHaveTheStiffnessOfTheirMaterials) {
  SceneDesc scene = between_jaws(20, 0.4, 0.6, 0.2 * radius);
  MaterialDesc harder = scene.materials[0].material;
  harder.transverse_stiffness = 3 * stiffness;
  scene.materials.push_back({"harder", harder});
  scene.cables[0].sections = {{0.5, 1.0, "harder"}};
  World world(scene, initial_frames(scene));
  scenes::run(world, 200);
  EXPECT_NEAR(world.contact_wrench("left").force.y(), 2 * stiffness * 0.2 * radius * 0.2, 0.01 * stiffness * radius * 0.08);
}

TEST(Squeeze, CrossingCablesAreTwoHalvesInSeries) {
  MaterialDesc soft, harder;
  soft.radius = 0.004;
  soft.transverse_stiffness = stiffness;
  harder.radius = 0.002;
  harder.transverse_stiffness = 4 * stiffness;
  Touch touch;
  touch.radius = 0.002;
  set_crossed_lengths(soft, {-0.05, 0, 0}, {0.1, 0, 0}, harder, {0, -0.05, 0}, {0, 0.1, 0}, touch);
  EXPECT_NEAR(touch.length, 0.004, 1e-12);
  EXPECT_NEAR(touch.other_length, 0.008, 1e-12);
  EXPECT_NEAR(touch.soft_stiffness, 1 / (1 / (2 * stiffness * 0.004) + 1 / (8 * stiffness * 0.008)), 1e-6);
  set_crossed_lengths(soft, {0, 0, 0}, {0.1, 0, 0}, harder, {0.07, 0, 0.006}, {0.1, 0, 0}, touch);
  EXPECT_NEAR(touch.length, 0.03, 1e-12);
  EXPECT_NEAR(touch.other_length, 0.03, 1e-12);
}

TEST(Squeeze, LimitTellsWhatSqueezesOnce) {
  SceneDesc scene = between_jaws(20, 0.41, 0.44, 0.2 * radius);
  scene.materials[0].material.maximum_squeeze = 0.9 * stiffness * 0.2 * radius;
  World world(scene, initial_frames(scene));
  std::vector<Excursion> told;
  for (int i = 0; i < 200; ++i) {
    scenes::run(world, 1);
    told.insert(told.end(), world.findings().excursions.begin(), world.findings().excursions.end());
  }
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].kind, Excursion::Kind::squeeze);
  EXPECT_EQ(told[0].node, 8);
  EXPECT_TRUE(told[0].other == "left" || told[0].other == "right");
  EXPECT_NE(excursion_text(told[0]).find("above maximum_squeeze, 90 N/m"), std::string::npos) << excursion_text(told[0]);
}

TEST(Squeeze, ClosesTheLedger) {
  SceneDesc scene = between_jaws(20, 0.41, 0.44, 0.5 * radius);
  scene.gravity.acceleration = {0, 0, -9.81};
  World world(scene, initial_frames(scene));
  scenes::run(world, 500);
  const Ledger ledger = world.ledger();
  EXPECT_EQ(ledger.unaccounted_steps, 0);
  EXPECT_GT(ledger.balance.dissipated.contact, -1e-9);
}

}  // namespace
}  // namespace verlet_cable

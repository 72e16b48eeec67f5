#include "scene/material_presets.h"

#include <gtest/gtest.h>

#include <fstream>

#include "scene_text.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {
namespace {

using test::errors_of;
using test::has_line;
using test::joined;
using test::replaced;
using test::sound_scene;

class MaterialPreset : public testing::TestWithParam<const char*> {
 protected:
  /// 1 m of it.
  std::string cable(const std::string& initial, const std::string& attachments) const {
    return std::string("cables: [{name: c, length: 1, segments: 40, material: ") + GetParam() + ", initial: " + initial +
           ", attachments: [" + attachments + "]}]";
  }
};

INSTANTIATE_TEST_SUITE_P(Each, MaterialPreset,
                         testing::Values("usb_cable", "ethernet_cat6", "nylon_rope_6mm", "dyneema_rope_4mm",
                                         "steel_wire_rope_4mm", "rubber_hose_16mm", "rov_tether", "surgical_thread"),
                         [](const auto& test) { return std::string(test.param); });

/// Steps a world for 0.5 s; the largest speed [m/s] in it.
double largest_speed(World& world, const BoundaryInputs& frames) {
  double largest = 0;
  for (int i = 0; i < 500; ++i) {
    EXPECT_EQ(world.step(frames).status, StepResult::Status::ok) << i;
    for (const Vector3& velocity : world.cables()[0].state.velocities) {
      EXPECT_TRUE(velocity.allFinite());
      largest = std::max(largest, velocity.norm());
    }
  }
  EXPECT_EQ(world.cables().size(), 1u) << "it broke";
  return largest;
}

TEST_P(MaterialPreset, hangsStillOnceSettled) {
  const SceneDesc scene =
      read_scene_text(cable("{type: settled}", "{name: a, at: start}, {name: b, at: end, offset: [0.6, 0, 0.1]}"));
  const BoundaryInputs frames = initial_frames(scene);
  World world(scene, frames);
  EXPECT_TRUE(world.settle());
  // A thousandth of the length a second: what falls is a thousand times as fast.
  EXPECT_LT(largest_speed(world, frames), 1e-3);
  const double weight = 9.81 * world.cables()[0].model->material.linear_density;
  const Vector3 force = world.attachments()[0].force + world.attachments()[1].force;
  // The two ends carry the cable.
  EXPECT_NEAR(force.z() / weight, -1, 1e-2);
}

TEST_P(MaterialPreset, standsOutOfAClampAndIsReleased) {
  const SceneDesc settled = read_scene_text(cable("{type: settled}", "{name: a, at: start, type: clamp}"));
  const BoundaryInputs frames = initial_frames(settled);
  World world(settled, frames);
  EXPECT_TRUE(world.settle());
  EXPECT_LT(largest_speed(world, frames), 1e-3);
  // Large deflections are smaller than what is linear in the load, q L^4 / (8 EI), and a cable hangs no lower than it is long.
  const MaterialDesc& material = world.cables()[0].model->material;
  const double small = 9.81 * material.linear_density / (8 * material.bending_stiffness.largest());
  const double tip = -world.cables()[0].state.positions.back().z();
  EXPECT_GT(tip, 0);
  EXPECT_LT(tip, std::min(1.001 * small, 1 + 9.81 * material.linear_density / material.axial_stiffness));

  const SceneDesc straight = read_scene_text(cable("{type: straight, to: [1, 0, 0]}", "{name: a, at: start, type: clamp}"));
  World released(straight, frames);
  EXPECT_GT(largest_speed(released, frames), 0.01);
}

TEST(MaterialPresets, areThoseOfTheFile) {
  std::ifstream file(CONFIG_DIRECTORY "/materials.yaml");
  const YAML::Node root = YAML::Load(file);
  ASSERT_EQ(root.size(), material_presets().size());
  for (const NamedMaterial& preset : material_presets()) {
    ASSERT_TRUE(root[preset.name]) << preset.name;
    EXPECT_EQ(root[preset.name]["radius"].as<double>(), preset.material.radius);
  }
}

TEST(MaterialPresets, aSceneOwnMaterialOfTheNameWins) {
  const std::string text = "cables: [{name: c, length: 1, segments: 4, material: usb_cable}]";
  EXPECT_GT(read_scene_text(text).find_material("usb_cable")->bending_stiffness.smallest(), 0);
  const SceneDesc own = read_scene_text("materials: {usb_cable: {linear_density: 3, radius: 0.5}}\n" + text);
  EXPECT_EQ(own.find_material("usb_cable")->linear_density, 3);
  EXPECT_EQ(own.find_material("usb_cable")->bending_stiffness, BendingStiffness(0));
  EXPECT_EQ(own.materials.size(), 1u);
}

TEST(MaterialPresets, onlyWhatIsNamedIsInTheSceneAndOnlyOnce) {
  const SceneDesc scene = read_scene_text(
      "cables: [{name: c, length: 1, segments: 4, material: rov_tether}, {name: d, length: 1, segments: 4, material: "
      "rov_tether}]");
  ASSERT_EQ(scene.materials.size(), 1u);
  EXPECT_EQ(scene.materials[0].name, "rov_tether");
}

TEST(MaterialPresets, anUnknownMaterialListsWhatThereIs) {
  const auto errors = errors_of(replaced(sound_scene, "material: m", "material: rov_tehter"));
  ASSERT_EQ(errors.size(), 1u) << joined(errors);
  EXPECT_EQ(
      errors[0],
      "cables[0].material: \"rov_tehter\"; allowed: a material of the scene (m), or one that is shipped (usb_cable, "
      "ethernet_cat6, nylon_rope_6mm, dyneema_rope_4mm, steel_wire_rope_4mm, rubber_hose_16mm, rov_tether, surgical_thread)");
  EXPECT_TRUE(has_line(errors_of("cables: [{name: c, length: 1, segments: 4, material: x}]"),
                       "cables[0].material: \"x\"; allowed: a material of the scene (there are none), or one that is shipped ("));
}

}  // namespace
}  // namespace verlet_cable

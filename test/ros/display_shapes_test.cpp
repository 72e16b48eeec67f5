// Colors and wrenches of the display, without a ROS master.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <tuple>
#include <vector>

#include "publish/color.h"
#include "publish/conversions.h"
#include "publish/point_cloud.h"

namespace verlet_cable {
namespace {

// Coordinates are of order 1 and computed with some ten roundings.
constexpr double rounding = 1e-13;

SceneDesc scene_with(double linear_density, double length, double payload, double axial_stiffness) {
  SceneDesc scene;
  NamedMaterial material;
  material.name = "rope";
  material.material.linear_density = linear_density;
  material.material.radius = 0.01;
  material.material.axial_stiffness = axial_stiffness;
  scene.materials.push_back(material);
  CableDesc cable;
  cable.name = "rope";
  cable.length = length;
  cable.segments = 2;
  cable.material = "rope";
  cable.point_masses.push_back({{PlaceDesc::At::end, 0}, payload});
  scene.cables.push_back(cable);
  return scene;
}

SimulatedCable two_segments(double first_tension, double second_tension) {
  CableModel model;
  model.name = "rope";
  model.material.linear_density = 0.1;
  model.color = {0.1, 0.2, 0.3, 0.4};
  SimulatedCable cable;
  cable.model = std::make_shared<const CableModel>(model);
  cable.state.rest_lengths = {1, 1};
  cable.state.masses = {0.05, 0.1, 0.05};
  cable.state.positions = {{0, 0, 0}, {1, 0, 0}, {2.1, 0, 0}};
  cable.state.velocities.assign(3, Vector3::Zero());
  cable.state.tension = {first_tension, second_tension};
  return cable;
}

bool same(const std_msgs::ColorRGBA& a, const std_msgs::ColorRGBA& b) {
  return std::tie(a.r, a.g, a.b, a.a) == std::tie(b.r, b.g, b.b, b.a);
}

TEST(Color, GoesFromBlueToRedAndStopsThere) {
  const std_msgs::ColorRGBA slack = color_of_load(0), taut = color_of_load(1);
  EXPECT_GT(slack.b, slack.r + 0.3f);
  EXPECT_GT(taut.r, taut.b + 0.5f);
  EXPECT_TRUE(same(color_of_load(-3), slack));
  EXPECT_TRUE(same(color_of_load(17), taut));
}

TEST(Color, HasNoJumps) {
  // The widest step between two of the nine stops is 0.24 of a channel, so a thousandth of the map changes at most 0.0019.
  for (int i = 0; i < 1000; ++i) {
    const std_msgs::ColorRGBA a = color_of_load(i / 1000.0), b = color_of_load((i + 1) / 1000.0);
    EXPECT_LT(std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)}), 0.0020f);
  }
}

TEST(Color, IsPackedAsPointCloudsHaveIt) {
  std_msgs::ColorRGBA color;
  color.r = 1.0f;
  color.g = 0.5f;
  color.b = 0.2f;
  const float packed = packed_rgb(color);
  std::uint32_t bits;
  std::memcpy(&bits, &packed, sizeof(bits));
  EXPECT_EQ(bits, 0x00ff8033u);
}

TEST(Color, ScaleIsTheWeightOfTheHeaviestCable) {
  const ColorScale scale(scene_with(0.1, 2.0, 0.3, 1000.0));
  EXPECT_DOUBLE_EQ(scale.full_tension(), (0.1 * 2.0 + 0.3) * 9.81);
  EXPECT_DOUBLE_EQ(scale.full_strain(), scale.full_tension() / 1000.0);
  EXPECT_GT(ColorScale(scene_with(0.1, 2.0, 0.3, infinity)).full_strain(), 0);
}

/// A rope between two points, after some steps.
World rope_between(double span, const SceneDesc& rope) {
  SceneDesc scene = rope;
  scene.cables.front().segments = 20;
  scene.cables.front().point_masses.clear();
  for (const double x : {0.0, span}) {
    AttachmentDesc attachment;
    attachment.name = x == 0 ? "left" : "right";
    attachment.place.at = x == 0 ? PlaceDesc::At::start : PlaceDesc::At::end;
    attachment.offset.x() = x;
    scene.cables.front().attachments.push_back(attachment);
  }
  World world(scene, initial_frames(scene));
  for (int i = 0; i < 20; ++i) world.step(initial_frames(scene));
  return world;
}

TEST(Color, TheRangeFollowsTheLargestTensionAndFades) {
  const SceneDesc scene = scene_with(0.1, 2.0, 0, infinity);
  const double weight = 0.1 * 2.0 * 9.81;
  // Sag of a rope that is nearly straight: 8 sag^2 = 3 span (length - span); tension weight span / (8 sag), ten times the weight.
  const World taut = rope_between(1.9995, scene), slack = rope_between(1.0, scene);
  const std::vector<double>& tension = taut.cables().front().state.tension;
  const double largest = *std::max_element(tension.begin(), tension.end());
  ASSERT_GT(largest, 5 * weight);
  ColorScale scale(scene);
  EXPECT_FALSE(scale.follow(slack, 0.1)) << "never less than the weight";
  EXPECT_TRUE(scale.follow(taut, 0.1));
  EXPECT_GE(scale.legend().values.back(), largest);
  EXPECT_LE(scale.legend().values.back(), 1.34 * largest) << "the next round number";
  EXPECT_FALSE(scale.follow(taut, 0.1)) << "a legend that changes all the time is not read";
  EXPECT_FALSE(scale.follow(slack, 1)) << "what was there a second ago is still shown";
  EXPECT_TRUE(scale.follow(slack, 60));
  EXPECT_DOUBLE_EQ(scale.legend().values.back(), weight);
}

TEST(Color, OfANodeIsTheMeanOfItsSegments) {
  SceneDesc scene = scene_with(0.1, 2.0, 0.3, infinity);
  const double full = ColorScale(scene).full_tension();
  const SimulatedCable cable = two_segments(0.2 * full, 0.6 * full);
  const auto by_tension = ColorScale(scene).node_colors(cable, {});
  ASSERT_EQ(by_tension.size(), 3u);
  EXPECT_TRUE(same(by_tension[0], color_of_load(0.2)));
  EXPECT_TRUE(same(by_tension[1], color_of_load(0.4)));
  EXPECT_TRUE(same(by_tension[2], color_of_load(0.6)));
}

TEST(Color, LegendHasTheColorsOfTheCables) {
  SceneDesc scene = scene_with(0.1, 2.0, 0.3, 1000.0);
  const SimulatedCable first = two_segments(0, 0);
  for (const ColorBy color_by : {ColorBy::tension, ColorBy::strain, ColorBy::contact}) {
    scene.color_by = color_by;
    const ColorScale scale(scene);
    const Legend legend = scale.legend();
    ASSERT_EQ(legend.values.size(), legend.colors.size());
    for (std::size_t i = 0; i < legend.values.size(); ++i) {
      SimulatedCable cable = two_segments(legend.values[i], legend.values[i]);
      if (color_by == ColorBy::strain)
        for (int node = 1; node < 3; ++node) cable.state.positions[node].x() = node * (1 + legend.values[i] / 100);
      const std_msgs::ColorRGBA shown = scale.node_colors(cable, {legend.values[i], legend.values[i]})[1];
      for (const auto& channel : {&std_msgs::ColorRGBA::r, &std_msgs::ColorRGBA::g, &std_msgs::ColorRGBA::b})
        EXPECT_NEAR(shown.*channel, legend.colors[i].*channel, 1e-5) << legend.quantity << " " << legend.values[i];
    }
    EXPECT_TRUE(std::is_sorted(legend.values.begin(), legend.values.end()));
    EXPECT_EQ(legend.unit, color_by == ColorBy::strain ? "%" : "N");
    EXPECT_EQ(legend.quantity.find("cube root") != std::string::npos, color_by == ColorBy::contact);
  }
}

TEST(Color, LegendIsEmptyWhereColorsMeanNothing) {
  SceneDesc scene = scene_with(0.1, 2.0, 0.3, 1000.0);
  scene.color_by = ColorBy::cable;
  EXPECT_TRUE(ColorScale(scene).legend().values.empty());
  EXPECT_TRUE(ColorScale(SceneDesc{}).legend().quantity.empty());
}

TEST(Color, ByStrainAndByCable) {
  SceneDesc scene = scene_with(0.1, 2.0, 0.3, 1000.0);
  const SimulatedCable cable = two_segments(0, 0);  // strained by 0 and 10 %
  scene.color_by = ColorBy::strain;
  const ColorScale by_strain(scene);
  EXPECT_TRUE(same(by_strain.node_colors(cable, {})[0], color_of_load(0)));
  EXPECT_TRUE(same(by_strain.node_colors(cable, {})[2], color_of_load(1)));
  scene.color_by = ColorBy::cable;
  for (const std_msgs::ColorRGBA& color : ColorScale(scene).node_colors(cable, {})) {
    EXPECT_FLOAT_EQ(color.r, 0.1f);
    EXPECT_FLOAT_EQ(color.g, 0.2f);
    EXPECT_FLOAT_EQ(color.b, 0.3f);
    EXPECT_FLOAT_EQ(color.a, 0.4f);
  }
}

TEST(Finite, EveryArrayCounts) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(is_finite(two_segments(1, 2)));
  SimulatedCable cable = two_segments(1, 2);
  cable.state.positions[1].y() = nan;
  EXPECT_FALSE(is_finite(cable));
  cable = two_segments(1, 2);
  cable.state.velocities[2].z() = infinity;
  EXPECT_FALSE(is_finite(cable));
  EXPECT_FALSE(is_finite(two_segments(1, nan)));
}

TEST(Wrench, IsInTheAxesOfTheFrameAndAboutItsOrigin) {
  // The frame stands turned by 90 degrees about z, so that its x is the fixed y; the cable pulls with 3 N downwards, 0.2 m along
  // the frame's x, and twists the holder about the fixed x, which is the frame's -y, with 0.5 N m.
  Attachment attachment;
  attachment.pose.position = Vector3(0.2, 0, 0);
  attachment.force = Vector3(0, 0, -3);
  attachment.torque = Vector3(0.5, 0, 0);
  const Pose frame{Vector3(5, 6, 7), Quaternion(Eigen::AngleAxisd(M_PI_2, Vector3::UnitZ()))};
  const geometry_msgs::Wrench wrench = wrench_on_frame(attachment, frame);
  EXPECT_NEAR(wrench.force.x, 0, rounding);
  EXPECT_NEAR(wrench.force.y, 0, rounding);
  EXPECT_NEAR(wrench.force.z, -3, rounding);
  EXPECT_NEAR(wrench.torque.x, 0, rounding);
  EXPECT_NEAR(wrench.torque.y, 0.2 * 3 - 0.5, rounding);
  EXPECT_NEAR(wrench.torque.z, 0, rounding);
}

/// The tensions of a net that was torn away may be.
TEST(PointCloud, NumbersAreFiniteThatAreTooLargeForFloats) {
  EXPECT_EQ(to_float(1e54), std::numeric_limits<float>::max());
  EXPECT_EQ(to_float(-1e54), std::numeric_limits<float>::lowest());
  EXPECT_EQ(to_float(0.1), 0.1f);
}

}  // namespace
}  // namespace verlet_cable

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}

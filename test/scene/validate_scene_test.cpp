#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <tuple>

#include "scene_text.h"
#include "verlet_cable/core/scene_fields.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {
namespace {

using test::has_line;
using test::joined;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

AttachmentDesc attachment(const std::string& name, const PlaceDesc& place, const std::string& frame, const Vector3& offset) {
  AttachmentDesc result;
  result.name = name;
  result.place = place;
  result.frame = frame;
  result.offset = offset;
  return result;
}

constexpr PlaceDesc at_start{PlaceDesc::At::start, 0};
constexpr PlaceDesc at_end{PlaceDesc::At::end, 0};
PlaceDesc at_arc_length(double arc_length) {
  return {PlaceDesc::At::arc_length, arc_length};
}

/// A cable of 1 m in 10 segments, held by two points of the fixed frame.
SceneDesc held_scene(double distance) {
  SceneDesc scene;
  scene.materials.push_back({"m", {}});
  scene.materials[0].material.linear_density = 0.1;
  scene.materials[0].material.radius = 0.01;
  CableDesc cable;
  cable.name = "c";
  cable.material = "m";
  cable.length = 1;
  cable.segments = 10;
  cable.attachments = {attachment("a", at_start, "", Vector3::Zero()), attachment("b", at_end, "", {distance, 0, 0})};
  scene.cables.push_back(cable);
  return scene;
}

template <class Fields, class Owner>
void expect_ranges_checked(const SceneDesc& scene, Owner& owner, const Fields& fields, const std::string& prefix) {
  for (const auto& field : fields) {
    const auto value = owner.*field.member;
    using Number = std::remove_const_t<decltype(value)>;
    for (const double good : {field.range.lowest, field.range.highest}) {
      owner.*field.member = static_cast<Number>(good);
      EXPECT_FALSE(has_line(validate(scene), prefix + field.key + ": " + "")) << field.key << " " << good;
    }
    owner.*field.member = static_cast<Number>(field.range.lowest - std::max(1.0, std::abs(field.range.lowest)));
    EXPECT_TRUE(has_line(validate(scene), prefix + field.key + ": ")) << field.key;
    if (std::is_same_v<Number, double>) {
      for (const double bad : {nan, -infinity, 2 * field.range.highest + 1}) {
        owner.*field.member = static_cast<Number>(bad);
        EXPECT_TRUE(has_line(validate(scene), prefix + field.key + ": ")) << field.key << " " << bad;
      }
      owner.*field.member = static_cast<Number>(infinity);
      EXPECT_NE(has_line(validate(scene), prefix + field.key + ": "), field.range.infinite) << field.key;
    }
    owner.*field.member = value;
  }
}

TEST(ValidateScene, everyRangeIsChecked) {
  SceneDesc scene = held_scene(0.5);
  ASSERT_EQ(joined(validate(scene)), "");
  // Free: at other lengths its attachments would be too far apart, which is another error of the same key.
  scene.cables[0].attachments.clear();
  // Long segments: what their inertia allows of damping is above the ranges.
  scene.cables[0].length = 1000;
  scene.cables[0].point_masses = {{at_end, 1.0}};
  expect_ranges_checked(scene, scene, scene_fields, "");
  expect_ranges_checked(scene, scene, scene_integer_fields, "");
  expect_ranges_checked(scene, scene.limits, limits_fields, "limits.");
  expect_ranges_checked(scene, scene.fluid, fluid_fields, "fluid.");
  SceneDesc in_waves = scene;
  in_waves.fluid.density = 1000;
  in_waves.fluid.surface = 0;
  in_waves.fluid.waves = {{0.5, 8, 0, 0}};
  ASSERT_EQ(joined(validate(in_waves)), "");
  expect_ranges_checked(in_waves, in_waves.fluid.waves[0], wave_fields, "fluid.waves[0].");
  // What yields and rubs is what bends.
  scene.materials[0].material.bending_stiffness = 0.01;
  expect_ranges_checked(scene, scene.materials[0].material, material_fields, "materials.m.");
  expect_ranges_checked(scene, scene.cables[0], cable_fields, "cables[0].");
  expect_ranges_checked(scene, scene.cables[0], cable_integer_fields, "cables[0].");
  expect_ranges_checked(scene, scene.cables[0].point_masses[0], point_mass_fields, "cables[0].point_masses[0].");
}

TEST(ValidateScene, wavesNeedWaterAndGravity) {
  SceneDesc scene = held_scene(0.5);
  scene.fluid.waves = {{0.5, 8, 0, 0}};
  scene.gravity.acceleration = {0, 1, -9.81};
  const std::vector<std::string> lines = validate(scene);
  EXPECT_TRUE(has_line(lines, "fluid.density: 0; allowed: any number above 0 [kg/m^3], with fluid.waves"));
  EXPECT_TRUE(has_line(lines, "fluid.surface: .inf; allowed: any number [m], with fluid.waves"));
  EXPECT_TRUE(has_line(lines, "gravity: [0, 1, -9.81]; allowed: [0, 0, -g] with any g above 0 [m/s^2], with fluid.waves"));
  EXPECT_EQ(lines.size(), 3u);
  scene.fluid.density = 1000;
  scene.fluid.surface = 0;
  for (const Vector3& upwards : {Vector3(0, 0, 0), Vector3(0, 0, 9.81)}) {
    scene.gravity.acceleration = upwards;
    EXPECT_TRUE(has_line(validate(scene), "gravity: "));
  }
  scene.gravity.acceleration = {0, 0, -9.81};
  EXPECT_EQ(joined(validate(scene)), "");
  scene.gravity.type = GravityDesc::Type::central;
  EXPECT_TRUE(has_line(validate(scene), "gravity: central; allowed: "));
}

TEST(ValidateScene, restShapesAndRibbonsNeedTorsionalStiffness) {
  SceneDesc scene = held_scene(0.5);
  MaterialDesc& material = scene.materials[0].material;
  RestCurvatureDesc& curvature = scene.cables[0].rest_curvature;
  const auto is_named = [&] {
    return has_line(validate(scene), "materials.m.torsional_stiffness: 0; allowed: any number above 0");
  };
  curvature = {RestCurvatureDesc::Type::constant, {0, 1}, {}};
  EXPECT_FALSE(is_named());  // what does not resist bending has no shape
  material.bending_stiffness = 0.02;
  EXPECT_TRUE(is_named());
  EXPECT_TRUE(has_line(validate(scene),
                       "materials.m.torsional_stiffness: 0; allowed: any number above 0 [N m^2] with bending_stiffness, as "
                       "cables[0] has rest_curvature (a round section has about 0.75 times its bending_stiffness, 0.015)"));
  for (const auto& [type, is_curved] : {std::pair(RestCurvatureDesc::Type::straight, false),
                                        {RestCurvatureDesc::Type::initial, true},
                                        {RestCurvatureDesc::Type::profile, true}}) {
    curvature = {type, {0, 0}, {{0, 0}, {0, 1}}};
    EXPECT_EQ(is_named(), is_curved);
  }
  curvature = {RestCurvatureDesc::Type::profile, {0, 0}, {{0, 0}, {0, 0}}};
  EXPECT_FALSE(is_named());
  curvature = {RestCurvatureDesc::Type::constant, {0, 0}, {}};
  EXPECT_FALSE(is_named());
  scene.cables[0].rest_twist = 1;
  EXPECT_TRUE(is_named());
  scene.cables[0].rest_twist = 0;
  material.bending_stiffness = {0, 0.02};
  EXPECT_TRUE(is_named());
  curvature = {RestCurvatureDesc::Type::constant, {0, 1}, {}};
  scene.cables[0].rest_twist = 1;
  material.torsional_stiffness = 1e-3;
  EXPECT_EQ(joined(validate(scene)), "");
}

TEST(ValidateScene, defaultsAreInTheirRanges) {
  const SceneDesc scene;
  for (const auto& field : scene_fields) EXPECT_TRUE(field.range.contains(scene.*field.member)) << field.key;
  for (const auto& field : limits_fields) EXPECT_TRUE(field.range.contains(scene.limits.*field.member)) << field.key;
  for (const auto& field : fluid_fields) EXPECT_TRUE(field.range.contains(scene.fluid.*field.member)) << field.key;
  const MaterialDesc material;
  for (const auto& field : material_fields) EXPECT_NE(field.range.contains(material.*field.member), field.required) << field.key;
}

TEST(ValidateScene, cableIsAtLeastAsLongAsItsAttachmentsAreApart) {
  EXPECT_EQ(joined(validate(held_scene(1))), "");
  EXPECT_EQ(joined(validate(held_scene(1 + 1e-12))), "");
  EXPECT_TRUE(has_line(validate(held_scene(1.001)), "cables[0].length: 1 m of cable between \"a\" and \"b\"; allowed: at least"));
  SceneDesc elastic = held_scene(1.001);
  elastic.materials[0].material.axial_stiffness = 1e4;
  EXPECT_EQ(joined(validate(elastic)), "");
}

TEST(ValidateScene, onlyWhatIsHeldSettles) {
  SceneDesc scene = held_scene(0.5);
  scene.cables[0].initial.type = InitialShapeDesc::Type::settled;
  EXPECT_EQ(joined(validate(scene)), "");
  scene.cables[0].attachments.clear();
  EXPECT_TRUE(
      has_line(validate(scene), "cables[0].initial.type: settled without attachments; allowed: settled for a cable with"));
}

TEST(ValidateScene, dampingThatNoStepCanCarryIsRefused) {
  SceneDesc scene = held_scene(0.5);
  // 1e12 linear_density l^2 / time_step and 1e12 linear_density l^4 / time_step, with 0.1 kg/m, 0.1 m and 1 ms.
  const struct {
    double MaterialDesc::*member;
    double most;
    const char* line;
  } limits[] = {
      {&MaterialDesc::axial_damping, 1e12, ""},
      {&MaterialDesc::bending_damping, 1e10,
       "materials.m.bending_damping: 1.01e+10; allowed: at most 1e+10 [N m^2 s] for cables[0]"},
      {&MaterialDesc::torsional_damping, 1e10, "materials.m.torsional_damping: 1.01e+10; allowed: at most 1e+10 [N m^2 s] for"},
  };
  for (const auto& limit : limits) {
    double& damping = scene.materials[0].material.*limit.member;
    damping = 0.99 * limit.most;
    EXPECT_EQ(joined(validate(scene)), "");
    damping = 1.01 * limit.most;
    const std::vector<std::string> errors = validate(scene);
    ASSERT_EQ(errors.size(), 1u) << joined(errors);
    EXPECT_TRUE(has_line(errors, limit.line)) << joined(errors);
    damping = 0;
  }
  scene.cables[0].segments = 1000;
  scene.materials[0].material.axial_damping = 2e8;
  EXPECT_TRUE(has_line(validate(scene), "materials.m.axial_damping: 2e+08; allowed: at most ")) << joined(validate(scene));
}

TEST(ValidateScene, distancesAreThoseOfNeighboursAlongTheCable) {
  SceneDesc scene = held_scene(0.5);
  // 0.3 m of cable from the start to the middle one, 0.7 m from there to the end; listed last.
  scene.cables[0].attachments.push_back(attachment("middle", at_arc_length(0.31), "", {0.2, 0.2, 0}));
  EXPECT_EQ(joined(validate(scene)), "");
  scene.cables[0].attachments.back().offset = {0.2, 0.3, 0};
  const auto errors = validate(scene);
  ASSERT_EQ(errors.size(), 1u) << joined(errors);
  EXPECT_TRUE(has_line(errors, "cables[0].length: 0.3 m of cable between \"a\" and \"middle\"")) << joined(errors);
}

TEST(ValidateScene, heldSegmentsHaveTheirLength) {
  SceneDesc scene = held_scene(0.6);
  scene.cables[0].segments = 1;
  const auto errors = validate(scene);
  ASSERT_EQ(errors.size(), 1u) << joined(errors);
  EXPECT_TRUE(has_line(
      errors, "cables[0].segments: 1, no node between \"a\" and \"b\" is free, and a segment of 1 m would be 0.6 m long; "))
      << joined(errors);
  EXPECT_EQ(joined(validate(held_scene(0.6))), "");
  scene.cables[0].attachments[1].offset.x() = 1;
  EXPECT_EQ(joined(validate(scene)), "");
  scene.cables[0].attachments[1].offset.x() = 0.6;
  scene.materials[0].material.axial_stiffness = 100;
  EXPECT_EQ(joined(validate(scene)), "");
}

TEST(ValidateScene, clampsOfACableThatDoesNotBendHoldTheirNeighbours) {
  SceneDesc scene = held_scene(0.9);
  CableDesc& cable = scene.cables[0];
  for (AttachmentDesc& clamp : cable.attachments) clamp.type = AttachmentType::clamp;
  const double third = 1.0 / 3, half = 0.5;
  for (const auto& [segments, distance, is_fit] :
       {std::tuple{2, 2 * half, true}, {2, 0.9, false}, {3, 3 * third, true}, {3, 0.9, false}, {4, 0.9, true}}) {
    cable.segments = segments;
    cable.attachments[1].offset.x() = distance;
    EXPECT_EQ(has_line(validate(scene), "cables[0].segments: "), !is_fit) << segments << " " << joined(validate(scene));
  }
  cable.segments = 2;
  scene.materials[0].material.bending_stiffness = 0.01;
  EXPECT_EQ(joined(validate(scene)), "");
}

TEST(ValidateScene, distancesUseInitialPosesAndLeaveUnknownFramesOut) {
  SceneDesc scene = held_scene(0);
  AttachmentDesc& end = scene.cables[0].attachments[1];
  end.frame = "hand";
  end.offset = {1, 0, 0};
  EXPECT_EQ(joined(validate(scene)), "");
  // Turned by 90 degrees about z and moved by 0.5 m along y: the offset of 1 m points along y, too.
  end.initial_pose = InitialPose{0, 0.5, 0, 0, 0, M_PI / 2};
  EXPECT_TRUE(has_line(validate(scene), "cables[0].length: "));
  end.initial_pose = InitialPose{0, -0.5, 0, 0, 0, M_PI / 2};
  EXPECT_EQ(joined(validate(scene)), "");

  BoundaryInputs frames(2);
  frames[1].pose.position = {0.5, 0, 0};
  EXPECT_EQ(validate_distances(scene, frames).size(), 1u);
  frames[1].known = false;
  EXPECT_TRUE(validate_distances(scene, frames).empty());
}

TEST(ValidateScene, badNumbersDoNotHideOtherErrors) {
  SceneDesc scene = held_scene(0.5);
  scene.cables[0].length = nan;
  scene.cables[0].segments = -3;
  scene.cables[0].attachments[0].place = at_arc_length(nan);
  scene.cables[0].attachments[1].offset = {nan, 0, 0};
  scene.cables.push_back(held_scene(0.5).cables[0]);
  scene.cables[1].attachments[1].place = at_arc_length(nan);
  scene.cables[0].color[2] = infinity;
  scene.materials[0].material.radius = -1;
  scene.gravity.acceleration.x() = nan;
  const auto errors = validate(scene);
  for (const char* key : {"gravity: [nan, 0, -9.81]", "materials.m.radius: -1", "cables[0].length: nan", "cables[0].segments: -3",
                          "cables[0].color: [0.1, 0.1, inf, 1]", "cables[0].attachments[1].offset: [nan, 0, 0]",
                          "cables[1].attachments[1].at: nan"})
    EXPECT_TRUE(has_line(errors, key)) << key;
}

TEST(ValidateScene, placesMeanTheNearestNode) {
  const CableDesc cable = held_scene(0).cables[0];
  EXPECT_EQ(node_at(cable, at_start), 0);
  EXPECT_EQ(node_at(cable, at_end), 10);
  EXPECT_EQ(node_at(cable, at_arc_length(0.24)), 2);
  EXPECT_EQ(node_at(cable, at_arc_length(0.26)), 3);
  EXPECT_EQ(node_at(cable, at_arc_length(1)), 10);
}

TEST(ValidateScene, framesComeInOrderOfAppearanceEachOnce) {
  SceneDesc scene = held_scene(0.5);
  scene.cables[0].attachments[0].frame = "hand";
  scene.cables[0].attachments[1].frame = scene.frame_id;
  scene.cables.push_back(scene.cables[0]);
  scene.cables[1].attachments[0].frame = "arm";
  scene.cables[1].attachments[1].frame = "hand";
  scene.cables[1].attachments[1].initial_pose = InitialPose{1, 2, 3, 0, 0, M_PI};
  EXPECT_EQ(frame_names(scene), (std::vector<std::string>{"world", "hand", "arm"}));
  const BoundaryInputs frames = initial_frames(scene);
  ASSERT_EQ(frames.size(), 3u);
  EXPECT_TRUE(frames[0].known);
  EXPECT_TRUE(frames[1].known);
  EXPECT_FALSE(frames[2].known);
  EXPECT_EQ(frames[1].pose.position, Vector3(1, 2, 3));
  // Half a turn: 1e-15 is the rounding of pi.
  EXPECT_NEAR((frames[1].pose.orientation * Vector3::UnitX() + Vector3::UnitX()).norm(), 0, 1e-15);
}

}  // namespace
}  // namespace verlet_cable

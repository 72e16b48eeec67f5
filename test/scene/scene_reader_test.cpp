#include <gtest/gtest.h>

#include "scene/text.h"
#include "scene_text.h"

namespace verlet_cable {
namespace {

using test::replaced;
using test::sound_scene;

TEST(SceneReader, readsEveryKey) {
  const SceneDesc scene = read_scene_text(R"(
frame_id: map
origin: [500000, 5400000, 0]
time_step: 0.005
numerical_damping: false
gravity: [1, 2, 3]
publish_rate: 25
tf_latency: 0.1
tf_timeout: 1.5
on_lost_frame: pause
max_frame_speed: 3
on_time_jump: keep
marker_style: line
color_by: strain
scene_directory: ""
limits: {segments: 50, snapshots: 3, rollouts: 0}
seed: 7
integrator: verlet
nets: []
fluid: {density: 1000, velocity: [1, 2, 3], surface: 0.5, normal_drag: 1.1, tangential_drag: 0.02, depth: 30}
materials:
  rope: {linear_density: 0.2, radius: 0.01, drag: 0.3, friction: 0.5, axial_stiffness: 1e4, bending_stiffness: 0.02,
         torsional_stiffness: 0.015, axial_damping: 3, bending_damping: 0.001, torsional_damping: 0.002, breaking_tension: 900,
         rolling_friction: 0.3, yield_curvature: 2, hardening: 0.1, bending_friction: 0.004}
cables:
  - name: a
    length: 2
    segments: 4
    material: rope
    color: [0, 0.25, 0.5, 1]
    rest_curvature: [0.5, -0.25]
    rest_twist: -0.75
    initial: {type: points, points: [[0, 0, 0], [1, 0, 0], [1, 1, 0]], velocities: [[0, 0, 1], [0, 0, 2], [0, 0, 3]]}
    attachments:
      - {name: a1, at: 0.5, frame: hand, offset: [1, 2, 3], rotation: [0.1, 0.2, 0.3], type: clamp, initial_pose: [1, 2, 3, 4, 5, 6]}
    point_masses: [{at: end, mass: 0.5}, {at: start, mass: 0.25}]
  - name: b
    length: 1
    segments: 2
    material: rope
    rest_curvature: initial
    initial: {type: straight, from: [1, 1, 1], to: [1, 1, 2]}
  - {name: d, length: 1, segments: 2, material: rope, initial: {type: settled}, attachments: [{name: d1, at: start}]}
)");
  EXPECT_EQ(scene.frame_id, "map");
  EXPECT_EQ(scene.origin, Vector3(500000, 5400000, 0));
  EXPECT_EQ(scene.time_step, 0.005);
  EXPECT_FALSE(scene.numerical_damping);
  EXPECT_EQ(scene.gravity.acceleration, Vector3(1, 2, 3));
  EXPECT_EQ(scene.publish_rate, 25);
  EXPECT_EQ(scene.tf_latency, 0.1);
  EXPECT_EQ(scene.tf_timeout, 1.5);
  EXPECT_EQ(scene.on_lost_frame, LostFramePolicy::pause);
  EXPECT_EQ(scene.max_frame_speed, 3);
  EXPECT_EQ(scene.on_time_jump, TimeJumpPolicy::keep);
  EXPECT_EQ(scene.marker_style, MarkerStyle::line);
  EXPECT_EQ(scene.color_by, ColorBy::strain);
  EXPECT_EQ(scene.limits.segments, 50);
  EXPECT_EQ(scene.limits.snapshots, 3);
  EXPECT_EQ(scene.limits.rollouts, 0);
  EXPECT_EQ(scene.seed, 7);
  EXPECT_EQ(scene.fluid.density, 1000);
  EXPECT_EQ(scene.fluid.velocity, Vector3(1, 2, 3));
  EXPECT_EQ(scene.fluid.surface, 0.5);
  EXPECT_EQ(scene.fluid.normal_drag, 1.1);
  EXPECT_EQ(scene.fluid.tangential_drag, 0.02);
  EXPECT_EQ(scene.fluid.depth, 30);

  ASSERT_NE(scene.find_material("rope"), nullptr);
  EXPECT_EQ(scene.find_material("rope")->linear_density, 0.2);
  EXPECT_EQ(scene.find_material("rope")->radius, 0.01);
  EXPECT_EQ(scene.find_material("rope")->drag, 0.3);
  EXPECT_EQ(scene.find_material("rope")->axial_stiffness, 1e4);
  EXPECT_EQ(scene.find_material("rope")->bending_stiffness, BendingStiffness(0.02));
  EXPECT_EQ(scene.find_material("rope")->torsional_stiffness, 0.015);
  EXPECT_EQ(scene.find_material("rope")->axial_damping, 3);
  EXPECT_EQ(scene.find_material("rope")->bending_damping, 0.001);
  EXPECT_EQ(scene.find_material("rope")->torsional_damping, 0.002);
  EXPECT_EQ(scene.find_material("rope")->rolling_friction, 0.3);
  EXPECT_EQ(scene.find_material("rope")->yield_curvature, 2);
  EXPECT_EQ(scene.find_material("rope")->hardening, 0.1);
  EXPECT_EQ(scene.find_material("rope")->bending_friction, 0.004);
  EXPECT_EQ(scene.find_material("rope")->breaking_tension, 900);
  EXPECT_EQ(scene.find_material("string"), nullptr);

  ASSERT_EQ(scene.cables.size(), 3u);
  const CableDesc& a = scene.cables[0];
  EXPECT_EQ(a.name, "a");
  EXPECT_EQ(a.length, 2);
  EXPECT_EQ(a.segments, 4);
  EXPECT_EQ(a.material, "rope");
  EXPECT_EQ(a.color, (std::array<double, 4>{0, 0.25, 0.5, 1}));
  EXPECT_EQ(a.initial.type, InitialShapeDesc::Type::points);
  ASSERT_EQ(a.initial.points.size(), 3u);
  EXPECT_EQ(a.initial.points[2], Vector3(1, 1, 0));
  ASSERT_EQ(a.initial.velocities.size(), 3u);
  EXPECT_EQ(a.initial.velocities[1], Vector3(0, 0, 2));
  ASSERT_EQ(a.attachments.size(), 1u);
  EXPECT_EQ(a.attachments[0].name, "a1");
  EXPECT_EQ(a.attachments[0].place.at, PlaceDesc::At::arc_length);
  EXPECT_EQ(a.attachments[0].place.arc_length, 0.5);
  EXPECT_EQ(a.attachments[0].frame, "hand");
  EXPECT_EQ(a.attachments[0].offset, Vector3(1, 2, 3));
  EXPECT_EQ(a.attachments[0].rotation, Vector3(0.1, 0.2, 0.3));
  EXPECT_EQ(a.attachments[0].type, AttachmentType::clamp);
  EXPECT_EQ(a.attachments[0].initial_pose, (InitialPose{1, 2, 3, 4, 5, 6}));
  ASSERT_EQ(a.point_masses.size(), 2u);
  EXPECT_EQ(a.point_masses[0].place.at, PlaceDesc::At::end);
  EXPECT_EQ(a.point_masses[0].mass, 0.5);
  EXPECT_EQ(a.rest_curvature.type, RestCurvatureDesc::Type::constant);
  EXPECT_EQ(a.rest_curvature.curvature, (std::array<double, 2>{0.5, -0.25}));
  EXPECT_EQ(a.rest_twist, -0.75);
  EXPECT_EQ(scene.cables[1].rest_twist, 0);
  EXPECT_EQ(scene.cables[1].rest_curvature.type, RestCurvatureDesc::Type::initial);
  EXPECT_EQ(scene.cables[2].rest_curvature.type, RestCurvatureDesc::Type::straight);
  EXPECT_EQ(scene.cables[2].initial.type, InitialShapeDesc::Type::settled);
  EXPECT_EQ(scene.cables[1].initial.from, Vector3(1, 1, 1));
  EXPECT_EQ(scene.cables[1].initial.to, Vector3(1, 1, 2));
}

TEST(SceneReader, wavesAreReadInTheirOrder) {
  const SceneDesc scene = read_scene_text(
      "bodies: [{name: buoy, mass: 1, inertia: [1, 1, 1]}]\n"
      "fluid: {density: 1000, surface: 0, waves: [{amplitude: 0.5, period: 8}, {amplitude: 0.1, period: 3, direction: 0.2, "
      "phase: "
      "1}]}\n");
  ASSERT_EQ(scene.fluid.waves.size(), 2u);
  EXPECT_EQ(scene.fluid.waves[0].amplitude, 0.5);
  EXPECT_EQ(scene.fluid.waves[0].phase, 0);
  EXPECT_EQ(scene.fluid.waves[1].period, 3);
  EXPECT_EQ(scene.fluid.waves[1].direction, 0.2);
  EXPECT_EQ(scene.fluid.waves[1].phase, 1);
}

TEST(SceneReader, ACableWithAColorIsShownInItUnlessTheSceneSaysOtherwise) {
  const auto read = [](const std::string& color, const std::string& color_by) {
    return read_scene_text(
               "materials: {rope: {linear_density: 0.1, radius: 0.005}}\n"
               "cables: [{name: a, length: 1, segments: 4, material: rope}, {name: b, length: 1, segments: 4, material: rope" +
               color + "}]\n" + color_by)
        .color_by;
  };
  EXPECT_EQ(read("", ""), ColorBy::tension);
  EXPECT_EQ(read(", color: [1, 0.5, 0, 1]", ""), ColorBy::cable);
  EXPECT_EQ(read(", color: [1, 0.5, 0, 1]", "color_by: tension\n"), ColorBy::tension);
}

TEST(SceneReader, restCurvatureMayChangeAlongTheCable) {
  const SceneDesc scene =
      read_scene_text(replaced(sound_scene, "segments: 20", "segments: 20\n    rest_curvature: [[0.5, -0.25], [1, 2], [0, 3]]"));
  EXPECT_EQ(scene.cables[0].rest_curvature.type, RestCurvatureDesc::Type::profile);
  EXPECT_EQ(scene.cables[0].rest_curvature.profile, (std::vector<std::array<double, 2>>{{0.5, -0.25}, {1, 2}, {0, 3}}));
}

TEST(SceneReader, endsOfACableMayBeStiff) {
  const SceneDesc scene = read_scene_text(replaced(sound_scene, "segments: 20", "segments: 20\n    stiff_ends: [0.02, 0.03]"));
  EXPECT_EQ(scene.cables[0].stiff_ends, (std::array<double, 2>{0.02, 0.03}));
}

TEST(SceneReader, bendingStiffnessMayDifferAboutTwoAxes) {
  const SceneDesc scene = read_scene_text(
      replaced(sound_scene, "radius: 0.005", "radius: 0.005, bending_stiffness: [2e-2, 5e-5], torsional_stiffness: 7e-5"));
  EXPECT_EQ(scene.find_material("m")->bending_stiffness, BendingStiffness(2e-2, 5e-5));
}

TEST(SceneReader, elasticModuliMeanASolidRoundSection) {
  const SceneDesc scene =
      read_scene_text(replaced(sound_scene, "{linear_density: 0.1, radius: 0.005}",
                               "{density: 1200, youngs_modulus: 1e7, poisson_ratio: 0.25, radius: 0.01, drag: 0.3}"));
  const MaterialDesc& material = *scene.find_material("m");
  // A = pi r^2, I = pi r^4 / 4, J = pi r^4 / 2, G = E / (2 (1 + nu)) = 0.4 E; 1e-12 is rounding.
  EXPECT_NEAR(material.linear_density / (1200 * M_PI * 1e-4), 1, 1e-12);
  EXPECT_NEAR(material.axial_stiffness / (1e7 * M_PI * 1e-4), 1, 1e-12);
  EXPECT_NEAR(material.bending_stiffness.front() / (1e7 * M_PI * 1e-8 / 4), 1, 1e-12);
  EXPECT_NEAR(material.torsional_stiffness / (0.4e7 * M_PI * 1e-8 / 2), 1, 1e-12);
  EXPECT_EQ(material.drag, 0.3);
}

TEST(SceneReader, keepsDefaultsOfWhatIsNotGiven) {
  const SceneDesc defaults;
  const SceneDesc scene = read_scene_text(
      "{materials: {m: {linear_density: 1, radius: 1}}, cables: [{name: c, length: 1, segments: 1, material: m}]}");
  EXPECT_EQ(scene.frame_id, defaults.frame_id);
  EXPECT_EQ(scene.time_step, defaults.time_step);
  EXPECT_EQ(scene.gravity.acceleration, defaults.gravity.acceleration);
  EXPECT_EQ(scene.limits.segments, defaults.limits.segments);
  EXPECT_EQ(scene.find_material("m")->friction, MaterialDesc{}.friction);
  EXPECT_EQ(scene.cables[0].initial.type, InitialShapeDesc::Type::automatic);
  EXPECT_TRUE(scene.cables[0].attachments.empty());
}

TEST(SceneReader, numbersMayBeText) {
  const SceneDesc scene =
      read_scene_text(replaced(sound_scene, "time_step: 0.002", "time_step: \"1e-5\"\nmax_frame_speed: \"inf\"\nseed: 2.0"));
  EXPECT_EQ(scene.time_step, 1e-5);
  EXPECT_EQ(scene.max_frame_speed, infinity);
  EXPECT_EQ(scene.seed, 2);
}

TEST(SceneReader, parsesNumbers) {
  EXPECT_EQ(parse_number("1e-5"), 1e-5);
  EXPECT_EQ(parse_number("-.5E+2"), -50.0);
  EXPECT_EQ(parse_number("+3."), 3.0);
  EXPECT_EQ(parse_number("0.1"), 0.1);
  EXPECT_EQ(parse_number("1e-400"), 0.0);
  EXPECT_EQ(parse_number(".inf"), infinity);
  EXPECT_EQ(parse_number("-.Inf"), -infinity);
  EXPECT_EQ(parse_number("Infinity"), infinity);
  for (const char* text :
       {"", ".", "-", "nan", ".nan", "NaN", "1e400", "0x10", "1e", "e5", "1 2", "1.2.3", "1,5", "1_000", "inf2", "--1", " 1"})
    EXPECT_FALSE(parse_number(text)) << text;
}

TEST(SceneReader, aliasesStandForWhatTheyName) {
  const SceneDesc scene = read_scene_text(R"(
materials: {m: &m {linear_density: 0.1, radius: 0.1}, n: *m}
cables: [{name: c, length: 1, segments: 2, material: n, attachments: [{name: a, at: start, offset: &o [1, 2, 3]}, {name: b, at: end, offset: *o}]}]
)");
  EXPECT_EQ(scene.find_material("n")->radius, 0.1);
  EXPECT_EQ(scene.cables[0].attachments[1].offset, Vector3(1, 2, 3));
}

TEST(SceneReader, tellsOfSectionsThatSegmentsDoNotFit) {
  const auto warnings = [](const std::string& sections) {
    return warnings_of(read_scene_text(replaced(sound_scene, "segments: 20", "segments: 20\n    sections: [" + sections + "]")));
  };
  EXPECT_TRUE(warnings_of(read_scene_text(sound_scene)).empty());
  EXPECT_TRUE(warnings("{from: 0.1, to: 0.3, material: m}, {from: 0.499, to: 0.999, material: m}").empty());
  const std::vector<std::string> told = warnings("{from: 0.1, to: 0.3, material: m}, {from: 0.42, to: 0.62, material: m}");
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(
      told[0],
      "cables[0].sections[1]: 0.42 to 0.62 m; simulated from 0.4 to 0.6 m, as sections consist of whole segments, which are "
      "0.05 m long: more segments are shorter");
}

TEST(SceneReader, tellsOfScalesThatAreOffByAThousand) {
  const std::string material = "{linear_density: 0.1, radius: 0.005}", cable = "length: 1.0\n    segments: 20";
  const auto told = [&](const std::string& what, const std::string& with) {
    return test::joined(warnings_of(read_scene_text(replaced(sound_scene, what, with))));
  };
  EXPECT_EQ(
      told(material, "{linear_density: 0.1, radius: 5}"),
      "cables[0]: the radius of its material m, 5 m, is above a tenth of its length, 1 m; usual: below a hundredth; did you "
      "mean 0.005 m (5 mm)?\n");
  EXPECT_EQ(
      told(material, "{linear_density: 100, radius: 0.005}"),
      "materials.m: linear_density 100 kg/m and radius 0.005 m are matter of 1273240 kg/m^3; usual: 10 to 25000 kg/m^3; did "
      "you mean 0.1 kg/m (100 g/m)?\n");
  EXPECT_EQ(told(material, "{linear_density: 1.0e-4, radius: 0.005}"),
            "materials.m: linear_density 1e-04 kg/m and radius 0.005 m are matter of 1.27 kg/m^3; usual: 10 to 25000 kg/m^3\n");
  EXPECT_EQ(
      told(cable, "length: 1\n    segments: 250"),
      "cables[0].segments: 250 are 0.004 m long, shorter than the radius of m, 0.005 m; usual: longer than the cable is thick; "
      "did you mean 100?\n");
  EXPECT_EQ(told(cable, "length: 1500\n    segments: 20"),
            "cables[0].length: 1500 m; usual: up to 1000 m; did you mean 1.5 m (1500 mm)?\n");
  EXPECT_EQ(told("time_step: 0.002", "time_step: 0.06"),
            "time_step: 0.06 s; usual: up to 0.05 s; did you mean 0.001 s (1 ms)?\n");
  // A radius that is wrong for a long cable shows in the density.
  EXPECT_EQ(
      test::joined(warnings_of(read_scene_text(replaced(replaced(sound_scene, material, "{linear_density: 0.1, radius: 5}"),
                                                        cable, "length: 100\n    segments: 20")))),
      "materials.m: linear_density 0.1 kg/m and radius 5 m are matter of 0.00127 kg/m^3; usual: 10 to 25000 kg/m^3; did you "
      "mean 0.005 m (5 mm)?\n");
  // The ends of what is usual.
  EXPECT_EQ(told(cable, "length: 1000\n    segments: 20") + told(cable, "length: 1\n    segments: 200") +
                told("time_step: 0.002", "time_step: 0.05"),
            "");
}

TEST(SceneReader, keepsTheFrameOfTheOriginFromOthers) {
  const auto errors = [](const std::string& text, const std::string& frame) -> std::string {
    try {
      read_scene_text(text, {{}, {}, frame});
    } catch (const SceneError& error) {
      return error.what();
    }
    return "";
  };
  const std::string moved = replaced(sound_scene, "time_step:", "origin: [5e5, 0, 0]\ntime_step:");
  EXPECT_EQ(
      errors(moved, "hand"),
      "cables[0].attachments[1].frame: \"hand\"; allowed: other names: with `origin`, the frame of this name is that of the "
      "markers and clouds");
  EXPECT_EQ(errors(moved, "cable_origin"), "");
  EXPECT_EQ(errors(moved, ""), "");
  EXPECT_EQ(errors(sound_scene, "hand"), "");
}

TEST(SceneReader, ignoresOnlyTheTopLevelKeysItIsToldTo) {
  const YAML::Node root = YAML::Load(sound_scene + "tuning: {gravity: 3}\n");
  EXPECT_NO_THROW(read_scene(root, {"tuning"}));
  EXPECT_THROW(read_scene(root), SceneError);
}

}  // namespace
}  // namespace verlet_cable

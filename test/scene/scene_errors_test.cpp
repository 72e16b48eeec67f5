#include <gtest/gtest.h>

#include "scene_text.h"

namespace verlet_cable {
namespace {

using test::errors_of;
using test::has_line;
using test::joined;
using test::replaced;
using test::sound_scene;

struct Mistake {
  const char* name;
  const char* what;   ///< in the sound scene
  const char* with;   ///< what a user wrote in its place
  const char* error;  ///< how the only error begins: key and value
};

std::ostream& operator<<(std::ostream& stream, const Mistake& mistake) {
  return stream << mistake.name;
}

class SceneMistake : public testing::TestWithParam<Mistake> {};

TEST_P(SceneMistake, isTheOnlyErrorAndSaysWhatIsAllowed) {
  const Mistake& mistake = GetParam();
  const std::vector<std::string> errors = errors_of(replaced(sound_scene, mistake.what, mistake.with));
  ASSERT_EQ(errors.size(), 1u) << joined(errors);
  EXPECT_EQ(errors[0].rfind(mistake.error, 0), 0u) << errors[0];
  EXPECT_NE(errors[0].find("; allowed: "), std::string::npos) << errors[0];
}

constexpr const char* time_step = "time_step: 0.002";
constexpr const char* gravity = "gravity: [0, 0, -9.81]";
constexpr const char* material = "{linear_density: 0.1, radius: 0.005}";
constexpr const char* length = "length: 1.0";
constexpr const char* left = "{name: left, at: start, type: hinge}";
constexpr const char* right = "frame: hand, initial_pose: [0.7, 0, 0, 0, 0, 0], type: clamp}";
constexpr const char* color = "color: [0.1, 0.1, 0.1, 1.0]";
constexpr const char* payload = "{at: 0.5, mass: 0.2}";

const Mistake mistakes[] = {
    {"unknownKey", gravity, "gravty: [0, 0, 0]", "gravty: unknown key, its value is [0, 0, 0] (did you mean gravity?)"},
    {"unknownKeyOfACable", color, "colour: red", "cables[0].colour: unknown key, its value is \"red\" (did you mean color?)"},
    {"unknownKeyOfAnAttachment", "type: hinge", "typ: hinge", "cables[0].attachments[0].typ: unknown key"},
    {"unknownKeyOfAMaterial", "radius: 0.005", "radius: 0.005, mass: 3", "materials.m.mass: unknown key, its value is 3"},
    {"doubledKey", time_step, "time_step: 0.002\ntime_step: 0.003", "time_step: given twice"},
    {"doubledMaterial", "materials:", "materials:\n  m: {linear_density: 0.1, radius: 0.005}", "materials.m: given twice"},
    {"zeroTimeStep", time_step, "time_step: 0", "time_step: 0;"},
    {"negativeTimeStep", time_step, "time_step: -1e-3", "time_step: -0.001;"},
    {"longTimeStep", time_step, "time_step: 0.2", "time_step: 0.2;"},
    {"nanTimeStep", time_step, "time_step: .nan", "time_step: \".nan\";"},
    {"infiniteTimeStep", time_step, "time_step: .inf", "time_step: inf;"},
    {"textTimeStep", time_step, "time_step: fast", "time_step: \"fast\";"},
    {"emptyTimeStep", time_step, "time_step:", "time_step: nothing;"},
    {"listTimeStep", time_step, "time_step: [0.1]", "time_step: [0.1];"},
    {"scalarGravity", gravity, "gravity: -9.81", "gravity: -9.81;"},
    {"shortGravity", gravity, "gravity: [0, -9.81]", "gravity: [0, -9.81];"},
    {"infiniteGravity", gravity, "gravity: [0, 0, -.inf]", "gravity: [0, 0, -inf];"},
    {"leadingSlash", "frame_id: world", "frame_id: /world", "frame_id: \"/world\";"},
    {"emptyFixedFrame", "frame_id: world", "frame_id: \"\"", "frame_id: \"\";"},
    {"zeroPublishRate", time_step, "publish_rate: 0", "publish_rate: 0;"},
    {"negativeLatency", time_step, "tf_latency: -0.1", "tf_latency: -0.1;"},
    {"zeroTimeout", time_step, "tf_timeout: 0", "tf_timeout: 0;"},
    {"zeroFrameSpeed", time_step, "max_frame_speed: 0", "max_frame_speed: 0;"},
    {"unknownPolicy", time_step, "on_lost_frame: wait", "on_lost_frame: \"wait\"; allowed: hold | release | pause"},
    {"unknownTimeJump", time_step, "on_time_jump: 3", "on_time_jump: 3; allowed: reset | keep"},
    {"unknownMarkerStyle", time_step, "marker_style: [tube]", "marker_style: [tube]; allowed: tube | line"},
    {"unknownColorBy", time_step, "color_by: speed", "color_by: \"speed\"; allowed: cable | tension | strain | contact"},
    {"fractionalSeed", time_step, "seed: 0.5", "seed: 0.5;"},
    {"hugeSeed", time_step, "seed: 3000000000", "seed: 3000000000;"},
    {"zeroLimit", time_step, "limits: {segments: 0}", "limits.segments: 0;"},
    {"unknownLimit", time_step, "limits: {cables: 3}", "limits.cables: unknown key"},
    {"tooManySegments", time_step, "limits: {segments: 19}", "cables: 20 segments in all; allowed: at most limits.segments = 19"},
    {"missingDensity", material, "{radius: 0.005}", "materials.m.linear_density: missing;"},
    {"missingRadius", material, "{linear_density: 0.1}", "materials.m.radius: missing;"},
    {"zeroRadius", "radius: 0.005", "radius: 0", "materials.m.radius: 0;"},
    {"negativeDrag", "radius: 0.005", "radius: 0.005, drag: -1", "materials.m.drag: -1;"},
    {"infiniteDensity", "linear_density: 0.1", "linear_density: .inf", "materials.m.linear_density: inf;"},
    {"materialIsNoMap", material, "rubber", "materials.m: \"rubber\";"},
    {"badMaterialName", "m: {linear", "\"m\": {linear_density: 1, radius: 1}\n  2m: {linear", "materials.2m: \"2m\";"},
    {"unknownMaterial", "material: m", "material: none_such",
     "cables[0].material: \"none_such\"; allowed: a material of the scene (m), or one that is shipped (usb_cable, "},
    {"missingMaterial", "    material: m\n", "", "cables[0].material: missing;"},
    {"missingName", "  - name: hose\n    length", "  - length", "cables[0].name: missing;"},
    {"badName", "name: hose", "name: my hose", "cables[0].name: \"my hose\";"},
    {"missingLength", "    length: 1.0\n", "", "cables[0].length: missing;"},
    {"zeroLength", length, "length: 0", "cables[0].length: 0;"},
    {"shortCable", length, "length: 0.6", "cables[0].length: 0.6 m of cable between \"left\" and \"right\";"},
    {"zeroSegments", "segments: 20", "segments: 0", "cables[0].segments: 0;"},
    {"fractionalSegments", "segments: 20", "segments: 20.5", "cables[0].segments: 20.5;"},
    {"tooBrightColor", color, "color: [0, 0, 255, 1]", "cables[0].color: [0, 0, 255, 1];"},
    {"shortColor", color, "color: [0, 0, 1]", "cables[0].color: [0, 0, 1];"},
    {"unknownShape", color, "initial: {type: round}",
     "cables[0].initial.type: \"round\"; allowed: straight | catenary | points | settled"},
    {"shapeWithoutType", color, "initial: {}", "cables[0].initial.type: missing;"},
    {"shapeIsNoMap", color, "initial: straight", "cables[0].initial: \"straight\";"},
    {"noDirection", color, "initial: {type: straight, from: [1, 0, 0], to: [1, 0, 0]}", "cables[0].initial.to: [1, 0, 0];"},
    {"pointsBesideStraight", color, "initial: {type: straight, points: [[0, 0, 0], [1, 0, 0]]}",
     "cables[0].initial.points: given with another type;"},
    {"onePoint", color, "initial: {type: points, points: [[0, 0, 0]]}", "cables[0].initial.points: 1 points;"},
    {"noPoints", color, "initial: {type: points}", "cables[0].initial.points: 0 points;"},
    {"longPoints", color, "initial: {type: points, points: [[0, 0, 0], [1.06, 0, 0]]}",
     "cables[0].initial.points: a polyline of 1.06 m;"},
    {"shortPoints", color, "initial: {type: points, points: [[0, 0, 0], [0.94, 0, 0]]}",
     "cables[0].initial.points: a polyline of 0.94 m;"},
    {"nanPoint", color, "initial: {type: points, points: [[0, 0, 0], [.nan, 0, 0]]}",
     "cables[0].initial.points[1]: [.nan, 0, 0];"},
    {"velocitiesOfOtherPoints", color, "initial: {type: points, points: [[0, 0, 0], [1, 0, 0]], velocities: [[0, 0, 0]]}",
     "cables[0].initial.velocities: 1 entries;"},
    {"badCurvature", color, "rest_curvature: round", "cables[0].rest_curvature: \"round\";"},
    {"payloadsAreAMap", "[{at: 0.5, mass: 0.2}]", "{}", "cables[0].point_masses: {};"},
    {"attachmentIsNoMap", left, "left", "cables[0].attachments[0]: \"left\";"},
    {"missingPlace", "at: start, type", "type", "cables[0].attachments[0].at: missing;"},
    {"unknownPlace", "at: start", "at: middle", "cables[0].attachments[0].at: \"middle\";"},
    {"placeBeyondTheEnd", "at: start", "at: 1.01", "cables[0].attachments[0].at: 1.01;"},
    {"placeBeforeTheStart", "at: start", "at: -0.1", "cables[0].attachments[0].at: -0.1;"},
    {"sameNode", "at: start", "at: 0.98",
     "cables[0].attachments[1].at: node 20; allowed: a node that no other attachment holds; cables[0].attachments[0] does"},
    {"unknownAttachmentType", "type: hinge", "type: weld", "cables[0].attachments[0].type: \"weld\"; allowed: hinge | clamp"},
    {"sameAttachmentName", "name: right", "name: left", "cables[0].attachments[1].name: \"left\";"},
    {"frameWithSlash", right, "frame: /hand}", "cables[0].attachments[1].frame: \"/hand\";"},
    {"frameWithBlank", right, "frame: my hand}", "cables[0].attachments[1].frame: \"my hand\";"},
    {"shortOffset", "type: hinge", "offset: [0, 0]", "cables[0].attachments[0].offset: [0, 0];"},
    {"nanRotation", "type: hinge", "rotation: [0, nan, 0]", "cables[0].attachments[0].rotation: [0, nan, 0];"},
    {"shortPose", right, "frame: hand, initial_pose: [0, 0, 0]}", "cables[0].attachments[1].initial_pose: [0, 0, 0];"},
    {"poseOfTheFixedFrame", right, "offset: [0.5, 0, 0], initial_pose: [0.7, 0, 0, 0, 0, 0]}",
     "cables[0].attachments[1].initial_pose: [0.7, 0, 0, 0, 0, 0]; allowed: the same initial_pose wherever a frame is named; "
     "\"world\""},
    {"zeroPayload", payload, "{at: 0.5, mass: 0}", "cables[0].point_masses[0].mass: 0;"},
    {"payloadBeyondTheEnd", payload, "{at: 2, mass: 1}", "cables[0].point_masses[0].at: 2;"},
    {"payloadWithoutMass", payload, "{at: end}", "cables[0].point_masses[0].mass: missing;"},
    {"negativeStiffness", "radius: 0.005", "radius: 0.005, bending_stiffness: -0.1", "materials.m.bending_stiffness: -0.1;"},
    {"zeroAxialStiffness", "radius: 0.005", "radius: 0.005, axial_stiffness: 0", "materials.m.axial_stiffness: 0;"},
    {"nanStiffness", "radius: 0.005", "radius: 0.005, torsional_stiffness: .nan", "materials.m.torsional_stiffness: \".nan\";"},
    {"infiniteBendingStiffness", "radius: 0.005", "radius: 0.005, bending_stiffness: .inf",
     "materials.m.bending_stiffness: inf;"},
    {"negativeStiffnessAboutOneAxis", "radius: 0.005", "radius: 0.005, bending_stiffness: [1, -0.1]",
     "materials.m.bending_stiffness: [1, -0.1]; allowed: 0 or more [N m^2]"},
    {"threeBendingStiffnesses", "radius: 0.005", "radius: 0.005, bending_stiffness: [1, 1, 1]",
     "materials.m.bending_stiffness: [1, 1, 1]; allowed: one number, or two"},
    {"ribbonWithoutTorsionalStiffness", "radius: 0.005", "radius: 0.005, bending_stiffness: [0.5, 0.02]",
     "materials.m.torsional_stiffness: 0; allowed: any number above 0 [N m^2] with a bending_stiffness that differs about y and "
     "z (a thin "
     "strip has about 1.4 times its smaller bending_stiffness, 0.028)"},
    {"twistedWithoutTorsionalStiffness", color, "rest_twist: 1",
     "materials.m.torsional_stiffness: 0; allowed: any number above 0 [N m^2] as cables[0] has rest_twist"},
    {"nanRestTwist", color, "rest_twist: .nan", "cables[0].rest_twist: \".nan\";"},
    {"infiniteRestTwist", color, "rest_twist: .inf", "cables[0].rest_twist: inf;"},
    {"tightTolerance", "cables:", "tolerance: 1e-7\ncables:", "tolerance: 1e-07; allowed: any number from 1e-6 to 1e-3 [1/s]"},
    {"badNumericalDamping", "cables:", "numerical_damping: 1\ncables:", "numerical_damping: 1; allowed: true | false"},
    {"noTransverseStiffness", "radius: 0.005", "radius: 0.005, transverse_stiffness: 0",
     "materials.m.transverse_stiffness: 0; allowed: any number above 0, or .inf [N/m^2]"},
    {"noSqueeze", "radius: 0.005", "radius: 0.005, maximum_squeeze: -1",
     "materials.m.maximum_squeeze: -1; allowed: any number above 0, or .inf [N/m]"},
    {"noYieldCurvature", "radius: 0.005", "radius: 0.005, bending_stiffness: 0.02, yield_curvature: 0",
     "materials.m.yield_curvature: 0; allowed: any number above 0, or .inf [1/m]"},
    {"moreHardeningThanStiffness", "radius: 0.005", "radius: 0.005, hardening: 1.5",
     "materials.m.hardening: 1.5; allowed: any number from 0 to 1"},
    {"negativeBendingFriction", "radius: 0.005", "radius: 0.005, bending_stiffness: 0.02, bending_friction: -1",
     "materials.m.bending_friction: -1; allowed: 0 or more [N m]"},
    {"yieldsWithoutBendingStiffness", "radius: 0.005", "radius: 0.005, yield_curvature: 3",
     "materials.m.yield_curvature: 3; allowed: .inf [1/m] for a material without bending_stiffness"},
    {"rubsWithoutBendingStiffness", "radius: 0.005", "radius: 0.005, bending_friction: 0.1",
     "materials.m.bending_friction: 0.1; allowed: 0 [N m] for a material without bending_stiffness"},
    {"moreRollingFrictionThanFriction", "radius: 0.005", "radius: 0.005, rolling_friction: 1.5",
     "materials.m.rolling_friction: 1.5; allowed: any number from 0 to 1"},
    {"negativeDamping", "radius: 0.005", "radius: 0.005, torsional_damping: -1", "materials.m.torsional_damping: -1;"},
    {"infiniteDamping", "radius: 0.005", "radius: 0.005, axial_damping: .inf", "materials.m.axial_damping: inf;"},
    {"zeroBreakingTension", "radius: 0.005", "radius: 0.005, breaking_tension: 0", "materials.m.breaking_tension: 0;"},
    {"tightRestCurvature", color, "rest_curvature: [0, 40]",
     "cables[0].rest_curvature: [0, 40]; allowed: at most 31.41 1/m in all with segments of 0.05 m, a quarter turn from one to "
     "the next; "
     "more segments allow more"},
    {"tightPlaceOfRestCurvature", color, "rest_curvature: [[1, 2], [30, 30]]", "cables[0].rest_curvature[1]: [30, 30];"},
    {"shortRestCurvature", color, "rest_curvature: [1]", "cables[0].rest_curvature: [1];"},
    {"nanRestCurvature", color, "rest_curvature: [1, .nan]", "cables[0].rest_curvature: [1, .nan];"},
    {"noPlaceOfRestCurvature", color, "rest_curvature: []", "cables[0].rest_curvature: [];"},
    {"onePlaceOfRestCurvature", color, "rest_curvature: [[1, 2]]", "cables[0].rest_curvature: 1 places; allowed: 2 or more"},
    {"shortPlaceOfRestCurvature", color, "rest_curvature: [[1, 2], [3]]", "cables[0].rest_curvature[1]: [3];"},
    {"infinitePlaceOfRestCurvature", color, "rest_curvature: [[1, 2], [3, .inf]]", "cables[0].rest_curvature[1]: [3, inf];"},
    {"negativeStiffEnd", color, "stiff_ends: [0.02, -0.1]", "cables[0].stiff_ends: [0.02, -0.1];"},
    {"oneStiffEnd", color, "stiff_ends: [0.02]", "cables[0].stiff_ends: [0.02];"},
    {"stiffEndsThatLeaveNothing", color, "stiff_ends: [0.5, 0.5]",
     "cables[0].stiff_ends: [0.5, 0.5]; allowed: together less than the cable's length, 1 m"},
    {"negativeFluidDensity", time_step, "fluid: {density: -1}", "fluid.density: -1;"},
    {"unknownKeyOfTheFluid", time_step, "fluid: {densty: 1}",
     "fluid.densty: unknown key, its value is 1 (did you mean density?)"},
    {"infiniteWind", time_step, "fluid: {velocity: [.inf, 0, 0]}", "fluid.velocity: [inf, 0, 0];"},
    {"nanSurface", time_step, "fluid: {surface: .nan}", "fluid.surface: \".nan\";"},
    {"surfaceBelowEverything", time_step, "fluid: {surface: -.inf}", "fluid.surface: -inf;"},
    {"negativeFluidDrag", time_step, "fluid: {normal_drag: -1.2}", "fluid.normal_drag: -1.2;"},
    {"waveWithoutAPeriod", time_step, "fluid: {density: 1000, surface: 0, waves: [{amplitude: 1}]}",
     "fluid.waves[0].period: missing"},
    {"waveOfNegativeHeight", time_step, "fluid: {density: 1000, surface: 0, waves: [{amplitude: -1, period: 3}]}",
     "fluid.waves[0].amplitude: -1;"},
    {"waveWithoutASurface", time_step, "fluid: {density: 1000, waves: [{amplitude: 1, period: 3}]}", "fluid.surface: .inf;"},
    {"noDepth", time_step, "fluid: {depth: 0}", "fluid.depth: 0;"},
    {"fluidIsNoMap", time_step, "fluid: water", "fluid: \"water\";"},
    {"unknownGravity", gravity, "gravity: {type: lateral}", "gravity.type: \"lateral\"; allowed: central"},
    {"gravityWithoutType", gravity, "gravity: {mu: 1}", "gravity.type: missing;"},
    {"zeroMu", gravity, "gravity: {type: central, mu: 0}", "gravity.mu: 0;"},
    {"nanCenter", gravity, "gravity: {type: central, center: [0, nan, 0]}", "gravity.center: [0, nan, 0];"},
};

INSTANTIATE_TEST_SUITE_P(Each, SceneMistake, testing::ValuesIn(mistakes),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(SceneErrors, soundSceneHasNone) {
  EXPECT_EQ(joined(errors_of(sound_scene)), "");
}

TEST(SceneErrors, allComeAtOnceAndInTheSameOrder) {
  std::string text = sound_scene;
  text = replaced(text, "gravity", "gravty");
  text = replaced(text, "segments: 20", "segments: 0");
  text = replaced(text, "length:", "lenght:");
  text = replaced(text, "material: m", "material: none_such");
  text = replaced(text, "radius: 0.005", "radius: 0.005, axial_stiffness: -3");
  const std::vector<std::string> errors = errors_of(text);
  EXPECT_TRUE(has_line(errors, "gravty: unknown key"));
  EXPECT_TRUE(has_line(errors, "cables[0].lenght: unknown key, its value is 1.0 (did you mean length?)"));
  EXPECT_TRUE(has_line(errors, "cables[0].length: missing"));
  EXPECT_TRUE(has_line(errors, "cables[0].segments: 0;"));
  EXPECT_TRUE(has_line(errors, "cables[0].material: \"none_such\";"));
  EXPECT_TRUE(has_line(errors, "materials.m.axial_stiffness: -3;"));
  EXPECT_EQ(errors.size(), 6u) << joined(errors);
  EXPECT_EQ(errors, errors_of(text));
}

/// Every contact and every marker has a copy of a name.
TEST(SceneErrors, namesAreNotLongerThanAThousandCharacters) {
  const auto named = [](const std::string& cable, const std::string& frame) {
    return replaced(replaced(sound_scene, "hose", cable), "frame: hand", "frame: " + frame);
  };
  EXPECT_EQ(joined(errors_of(named(std::string(1000, 'c'), std::string(1000, 'f')))), "");
  const auto errors = errors_of(named(std::string(1001, 'c'), std::string(1001, 'f')));
  EXPECT_EQ(errors.size(), 2u) << joined(errors);
  EXPECT_TRUE(has_line(errors, "cables[0].name: \"ccc")) << joined(errors);
  EXPECT_NE(joined(errors).find("...\"; allowed: at most 1000 letters, digits and _, a letter first\n"), std::string::npos);
  EXPECT_TRUE(has_line(errors, "cables[0].attachments[1].frame: \"fff")) << joined(errors);
  EXPECT_NE(joined(errors).find("without blanks, at most 1000 characters\n"), std::string::npos);
}

TEST(SceneErrors, elasticModuliAreOneSetOfKeys) {
  const auto errors_of_material = [](const std::string& keys) {
    return errors_of(replaced(sound_scene, "{linear_density: 0.1, radius: 0.005}", "{" + keys + "}"));
  };
  for (const char* poisson_ratio : {"0.45", "0.5", "0", "-0.9"})
    EXPECT_EQ(joined(errors_of_material("density: 1200, youngs_modulus: 1e7, radius: 0.005, poisson_ratio: " +
                                        std::string(poisson_ratio))),
              "")
        << poisson_ratio;
  for (const char* poisson_ratio : {"-1", "0.51", ".nan", ".inf"})
    EXPECT_TRUE(has_line(
        errors_of_material("density: 1200, youngs_modulus: 1e7, radius: 0.005, poisson_ratio: " + std::string(poisson_ratio)),
        "materials.m.poisson_ratio: "))
        << poisson_ratio;
  EXPECT_TRUE(
      has_line(errors_of_material("density: 1200, youngs_modulus: 1e7, radius: 0.005"), "materials.m.poisson_ratio: missing;"));
  EXPECT_TRUE(has_line(errors_of_material("density: 1200, youngs_modulus: -1, poisson_ratio: 0.6, radius: 0.005"),
                       "materials.m.youngs_modulus: -1;"));
  EXPECT_TRUE(has_line(errors_of_material("density: 1200, youngs_modulus: 1, poisson_ratio: 0.6, radius: 0.005"),
                       "materials.m.poisson_ratio: 0.6;"));
  EXPECT_TRUE(
      has_line(errors_of_material("density: 1200, youngs_modulus: 1e7, poisson_ratio: 0.4, radius: 0.005, linear_density: 1"),
               "materials.m.linear_density: given together with elastic moduli;"));
}

TEST(SceneErrors, differentInitialPosesOfAFrame) {
  const auto errors =
      errors_of(replaced(sound_scene, "{name: left, at: start, type: hinge}",
                         "{name: left, at: start, frame: hand, offset: [-0.5, 0, 0], initial_pose: [0.7, 0, 0, 0, 0, 1]}"));
  ASSERT_EQ(errors.size(), 1u) << joined(errors);
  EXPECT_EQ(errors[0].rfind("cables[0].attachments[1].initial_pose: [0.7, 0, 0, 0, 0, 0]; allowed: the same initial_pose "
                            "wherever a frame is named; \"hand\" has",
                            0),
            0u);
}

TEST(SceneErrors, sceneIsNotAMap) {
  EXPECT_TRUE(has_line(errors_of(""), "scene: nothing;"));
  EXPECT_TRUE(has_line(errors_of("- a\n- b\n"), "scene: [a, b];"));
  EXPECT_TRUE(has_line(errors_of("frame_id: world"), "cables: missing;"));
  EXPECT_TRUE(has_line(errors_of("cables: []"), "cables: [];"));
  EXPECT_TRUE(has_line(errors_of("materials: [m]"), "materials: [m];"));
  EXPECT_TRUE(has_line(errors_of("cables: {name: hose}"), "cables: {name: hose};"));
  EXPECT_TRUE(has_line(errors_of("? [a, b]\n: c\n"), "scene: key [a, b];"));
}

TEST(SceneErrors, syntaxErrorsHaveLineAndColumn) {
  EXPECT_TRUE(has_line(errors_of("a: [1, 2"), "line 1, column "));
  EXPECT_TRUE(has_line(errors_of("{"), "line 1, column 1: "));
  EXPECT_TRUE(has_line(errors_of("a: 1\nb: {c: 1\nd: }]"), "line 3, column "));
  EXPECT_TRUE(has_line(errors_of(sound_scene + "---\n" + sound_scene), "line 17, column 1: a second document"));
}

TEST(SceneErrors, syntaxErrorsSayWhatIsMissing) {
  const std::string begin = "cables:\n  - name: rope\n";
  for (const auto& [text, error] : std::vector<std::pair<std::string, std::string>>{
           {begin + "\tlength: 1\n", "; line 3 begins with a tab; allowed: spaces"},
           {begin + "    length:1\n    segments: 10\n", "; line 3: a space is missing after \"length:\""},
           {"cables:\n  -name: rope\n    length: 1\n", "; line 2: a space is missing after the dash"},
           {begin + "    color: [1, 0, 0\n    length: 1\n", "; a comma or \"]\" is missing before it, for the \"[\" in line 3"},
           {begin + "    attachments: [{name: a, at: start]\n",
            "; a comma or \"}\" is missing before it, for the \"{\" in line 3"},
           {"m: {a: 1 b: 2}\n", "; a comma or \"}\" is missing before it, for the \"{\" in line 1"},
           {"a: \"}]\"  # }\nm: {a: '[', b: 2\n", "; a comma or \"}\" is missing before it, for the \"{\" in line 2"},
           {begin + "    material: my: rope\n", "; line 3: a value that contains \": \" needs quotes"},
           {"cables\n  - name: rope\n", "; line 1: a colon is missing after \"cables\""},
           {begin + "    length: 1\n     segments: 10\n",
            "; line 4 is indented by 5, line 3 by 4; the keys of a map begin in the same column"},
           {begin + "    length: 1\n   segments: 10\n",
            "; line 4 is indented by 3, line 3 by 4; the keys of a map begin in the same column"},
           {begin + "    material: @m\n", "; text that begins with one of @ ` % * & needs quotes"},
       }) {
    const std::vector<std::string> errors = errors_of(text);
    ASSERT_EQ(errors.size(), 1u) << text;
    EXPECT_EQ(errors[0].rfind(error), errors[0].size() - error.size()) << errors[0];
    EXPECT_EQ(errors[0].rfind("line ", 0), 0u) << errors[0];
  }
}

TEST(SceneErrors, aKeyWithoutSpaceInBracketsIsUnderstood) {
  const std::string text = "materials: {m: {linear_density: 0.1, radius:0.005}}\ncables: []\n";
  EXPECT_TRUE(
      has_line(errors_of(text), "materials.m.radius:0.005: unknown key, its value is nothing (did you mean radius: 0.005?)"));
}

}  // namespace
}  // namespace verlet_cable

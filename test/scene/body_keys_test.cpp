#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <ostream>

#include "scene_text.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {
namespace {

using test::errors_of;
using test::has_line;
using test::joined;
using test::replaced;

const std::string loads = R"(
materials:
  m: {linear_density: 0.1, radius: 0.005}
broadcast_tf: true
cables:
  - {name: rope, length: 1.1, segments: 11, material: m, attachments: [
      {name: top, at: start, offset: [0, 0, 2]},
      {name: hanging, at: end, body: hook, offset: [0, 0, 0.1], rotation: [0, 0, 1], type: clamp}]}
bodies:
  - name: hook
    mass: 0.5
    inertia: [1e-3, 2e-3, 2.5e-3]
    center_of_mass: [0, 0, -0.01]
    pose: [0, 0, 1, 0, 0.1, 0]
    velocity: [1, 0, 0]
    angular_velocity: [0, 0, 2]
    shapes:
      - {type: box, size: [0.02, 0.03, 0.04], pose: [0, 0, 0.1, 0, 0, 0]}
      - {type: capsule, radius: 0.01, length: 0.05}
    friction: 0.3
    linear_damping: 0.01
    angular_damping: 0.001
    fluid: {volume: 0.02, center: [0, 0.1, 0], drag_area: [0.1, 0.2, 0.3], angular_drag: [1, 2, 3], added_mass: [4, 5, 6]}
  - name: wheel
    mass: 2
    shapes: [{type: cylinder, radius: 0.1, length: 0.02}]
    attachments:
      - {name: bearing, frame: arm, type: axle, at: [0, 0, 0.01, 0, 0, 0], offset: [1, 0, 0], rotation: [0, 0, 0.5], initial_pose: [0, 0, 3, 0, 0, 0]}
      - {name: stay, body: hook}
)";

TEST(BodyKeys, areRead) {
  const SceneDesc scene = read_scene_text(loads);
  ASSERT_EQ(scene.bodies.size(), 2u);
  const BodyDesc &hook = scene.bodies[0], &wheel = scene.bodies[1];
  EXPECT_EQ(hook.name, "hook");
  EXPECT_EQ(hook.mass, 0.5);
  EXPECT_EQ(hook.inertia, Vector3(1e-3, 2e-3, 2.5e-3));
  EXPECT_EQ(hook.center_of_mass, Vector3(0, 0, -0.01));
  EXPECT_EQ(hook.pose, (InitialPose{0, 0, 1, 0, 0.1, 0}));
  EXPECT_EQ(hook.velocity, Vector3(1, 0, 0));
  EXPECT_EQ(hook.angular_velocity, Vector3(0, 0, 2));
  EXPECT_EQ(hook.fluid.volume, 0.02);
  EXPECT_EQ(hook.fluid.center, Vector3(0, 0.1, 0));
  EXPECT_EQ(hook.fluid.drag_area, Vector3(0.1, 0.2, 0.3));
  EXPECT_EQ(hook.fluid.angular_drag, Vector3(1, 2, 3));
  EXPECT_EQ(hook.fluid.added_mass, Vector3(4, 5, 6));
  ASSERT_EQ(hook.shapes.size(), 2u);
  EXPECT_EQ(hook.shapes[0].type, ShapeType::box);
  EXPECT_EQ(hook.shapes[0].size, Vector3(0.02, 0.03, 0.04));
  EXPECT_EQ(hook.shapes[0].pose, (InitialPose{0, 0, 0.1, 0, 0, 0}));
  EXPECT_EQ(hook.shapes[1].radius, 0.01);
  EXPECT_EQ(hook.friction, 0.3);
  EXPECT_EQ(hook.linear_damping, 0.01);
  EXPECT_EQ(hook.angular_damping, 0.001);
  EXPECT_FALSE(wheel.inertia);
  EXPECT_FALSE(wheel.center_of_mass);
  EXPECT_FALSE(wheel.pose);
  ASSERT_EQ(wheel.attachments.size(), 2u);
  const BodyAttachmentDesc &bearing = wheel.attachments[0], &stay = wheel.attachments[1];
  EXPECT_EQ(bearing.frame, "arm");
  EXPECT_EQ(bearing.type, AttachmentType::axle);
  EXPECT_EQ(bearing.at, (InitialPose{0, 0, 0.01, 0, 0, 0}));
  EXPECT_EQ(bearing.offset, Vector3(1, 0, 0));
  EXPECT_EQ(bearing.rotation, Vector3(0, 0, 0.5));
  EXPECT_EQ(bearing.initial_pose, (InitialPose{0, 0, 3, 0, 0, 0}));
  EXPECT_EQ(stay.body, "hook");
  EXPECT_EQ(stay.type, AttachmentType::hinge);
  EXPECT_EQ(scene.cables[0].attachments[1].body, "hook");
  EXPECT_EQ(scene.cables[0].attachments[1].frame, "");
}

TEST(BodyKeys, framesOfBodiesAreOfTheScene) {
  const SceneDesc scene = read_scene_text(loads);
  EXPECT_EQ(frame_names(scene), (std::vector<std::string>{"world", "arm"}));
  const BoundaryInputs frames = initial_frames(scene);
  ASSERT_TRUE(frames[1].known);
  EXPECT_EQ(frames[1].pose.position, Vector3(0, 0, 3));
}

TEST(BodyKeys, aSceneMayBeOfBodiesAlone) {
  EXPECT_EQ(joined(errors_of("bodies: [{name: top, mass: 1, inertia: [1, 2, 2]}]")), "");
  EXPECT_TRUE(
      has_line(errors_of("bodies: []"), "cables: missing; allowed: a list of at least one cable, or `nets`, `particles` or"));
}

TEST(BodyKeys, theCableIsNoShorterThanTheWayToItsBody) {
  EXPECT_TRUE(has_line(errors_of(replaced(loads, "offset: [0, 0, 2]}", "offset: [0, 0, 20]}")), "cables[0].length: "));
}

TEST(BodyKeys, inertiaFollowsFromShapesOnly) {
  const auto errors = [](const std::string& keys) { return errors_of("bodies: [{name: top, mass: 1, " + keys + "}]"); };
  EXPECT_TRUE(has_line(errors("friction: 1"), "bodies[0].inertia: missing; allowed: three numbers above 0 [kg m^2]"));
  EXPECT_EQ(joined(errors("shapes: [{type: sphere, radius: 0.1}]")), "");
  // What is wrong with the shapes is said once.
  EXPECT_EQ(errors("shapes: 5").size(), 1u) << joined(errors("shapes: 5"));
  EXPECT_EQ(errors("shapes: [{type: sphere, radius: 0}]").size(), 1u);
  EXPECT_EQ(errors("shapes: [{type: ball, radius: 1}]").size(), 1u) << joined(errors("shapes: [{type: ball, radius: 1}]"));
  EXPECT_EQ(errors("inertia: 5").size(), 1u) << joined(errors("inertia: 5"));
  EXPECT_TRUE(has_line(errors("shapes: [{type: sphere, radius: 1e-12}]"), "bodies[0].shapes: an inertia of ["));
}

TEST(BodyKeys, fluidIsChecked) {
  const auto errors = errors_of(replaced(loads, "volume: 0.02, center: [0, 0.1, 0], drag_area: [0.1, 0.2, 0.3]",
                                         "volume: -1, center: [0, .nan, 0], drag_area: [0.1, -0.2, 0.3]"));
  EXPECT_TRUE(has_line(errors, "bodies[0].fluid.volume: -1; allowed: 0 or more [m^3]")) << joined(errors);
  EXPECT_TRUE(has_line(errors, "bodies[0].fluid.center: "));
  EXPECT_TRUE(has_line(errors, "bodies[0].fluid.drag_area: [0.1, -0.2, 0.3]; allowed: three numbers, 0 or more [m^2]"));
  EXPECT_EQ(errors.size(), 3u) << joined(errors);
  EXPECT_TRUE(has_line(errors_of(replaced(loads, "added_mass: [4, 5, 6]", "added_mass: 4")), "bodies[0].fluid.added_mass: 4; "));
}

TEST(BodyKeys, openMeshesHaveNoInertia) {
  const std::string file = (std::filesystem::temp_directory_path() / "verlet_cable_body_keys_test.obj").string();
  const auto errors = [&](const std::string& faces) {
    std::ofstream(file) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n" << faces;
    return errors_of("bodies: [{name: top, mass: 1, shapes: [{type: mesh, uri: \"file://" + file + "\"}]}]");
  };
  EXPECT_EQ(joined(errors("f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n")), "");
  const auto open = errors("f 1 3 2\nf 1 2 4\nf 2 3 4\n");
  ASSERT_EQ(open.size(), 1u) << joined(open);
  EXPECT_TRUE(has_line(open, "bodies[0].inertia: missing;")) << joined(open);
  std::filesystem::remove(file);
}

TEST(BodyKeys, bodiesThatHoldEachOtherHaveAPose) {
  const std::string ring = R"(
bodies:
  - {name: a, mass: 1, inertia: [1, 1, 1], attachments: [{name: ab, body: b, type: clamp}]}
  - {name: b, mass: 1, inertia: [1, 1, 1], attachments: [{name: bc, body: c, type: axle}]}
  - {name: c, mass: 1, inertia: [1, 1, 1], attachments: [{name: ca, body: b, type: axle}]}
)";
  const auto errors = errors_of(ring);
  ASSERT_EQ(errors.size(), 1u) << joined(errors);
  EXPECT_TRUE(has_line(errors, "bodies[1].pose: missing, and the body is held by a body that it holds;")) << joined(errors);
  EXPECT_EQ(joined(errors_of(replaced(ring, "name: c, mass: 1", "name: c, mass: 1, pose: [0, 0, 0, 0, 0, 0]"))), "");
}

TEST(BodyKeys, framesNamedLikeBodiesAreErrorsOfTheBroadcast) {
  const std::string twice = replaced(loads, "frame: arm", "frame: hook");
  EXPECT_TRUE(
      has_line(errors_of(twice), "bodies[1].attachments[0].frame: \"hook\"; allowed: a frame that is not named like a body"));
  EXPECT_EQ(joined(errors_of(replaced(twice, "broadcast_tf: true", "broadcast_tf: false"))), "");
  EXPECT_TRUE(has_line(errors_of("frame_id: hook\n" + loads), "frame_id: \"hook\"; allowed: a frame that is not named"));
}

struct BodyMistake {
  const char* name;
  const char* what;
  const char* with;
  const char* error;
};

void PrintTo(const BodyMistake& mistake, std::ostream* stream) {
  *stream << mistake.name;
}

class BodyKeysMistake : public testing::TestWithParam<BodyMistake> {};

TEST_P(BodyKeysMistake, isNamed) {
  const auto errors = errors_of(replaced(loads, GetParam().what, GetParam().with));
  ASSERT_EQ(errors.size(), 1u) << joined(errors);
  EXPECT_EQ(errors[0].rfind(GetParam().error, 0), 0u) << errors[0];
  EXPECT_NE(errors[0].find("; allowed: "), std::string::npos) << errors[0];
}

const BodyMistake mistakes[] = {
    {"unknownKey", "friction: 0.3", "color: 0.3", "bodies[0].color: unknown key"},
    {"noName", "- name: wheel\n    mass", "- mass", "bodies[1].name: missing;"},
    {"noMass", "    mass: 0.5\n", "", "bodies[0].mass: missing;"},
    {"zeroMass", "mass: 0.5", "mass: 0", "bodies[0].mass: 0; allowed: any number above 0 [kg]"},
    {"negativeMass", "mass: 0.5", "mass: -1", "bodies[0].mass: -1;"},
    {"massOfText", "mass: 0.5", "mass: heavy", "bodies[0].mass: \"heavy\";"},
    {"inertiaOfNoBody", "[1e-3, 2e-3, 2.5e-3]", "[1, 0.1, 0.1]",
     "bodies[0].inertia: [1, 0.1, 0.1]; allowed: three numbers above 0"},
    {"zeroInertia", "[1e-3, 2e-3, 2.5e-3]", "[0, 1, 1]", "bodies[0].inertia: [0, 1, 1];"},
    {"twoMoments", "[1e-3, 2e-3, 2.5e-3]", "[1, 1]", "bodies[0].inertia: [1, 1];"},
    {"infiniteInertia", "[1e-3, 2e-3, 2.5e-3]", "[1, .inf, .inf]", "bodies[0].inertia: [1, inf, inf];"},
    {"noShape", "type: capsule, radius: 0.01, length: 0.05", "radius: 1", "bodies[0].shapes[1].type: missing;"},
    {"planeAsShape", "type: capsule, radius: 0.01, length: 0.05", "type: plane",
     "bodies[0].shapes[1].type: plane; allowed: sphere | capsule | cylinder | box | mesh"},
    {"frameOfShape", "length: 0.05}", "length: 0.05, frame: arm}", "bodies[0].shapes[1].frame: unknown key"},
    {"shapeWithoutLength", "radius: 0.01, length: 0.05", "radius: 0.01", "bodies[0].shapes[1].length: missing;"},
    {"noSize", "size: [0.02, 0.03, 0.04]", "size: [0.02, 0.03, 0]", "bodies[0].shapes[0].size: [0.02, 0.03, 0];"},
    {"farPose", "pose: [0, 0, 1, 0, 0.1, 0]", "pose: [0, 0, .inf, 0, 0, 0]", "bodies[0].pose: [0, 0, inf, 0, 0, 0];"},
    {"shortPose", "pose: [0, 0, 1, 0, 0.1, 0]", "pose: [0, 0, 1]", "bodies[0].pose: [0, 0, 1]; allowed: six numbers"},
    {"velocity", "velocity: [1, 0, 0]", "velocity: [1, 0, .inf]", "bodies[0].velocity: [1, 0, inf];"},
    {"angularVelocity", "angular_velocity: [0, 0, 2]", "angular_velocity: 2", "bodies[0].angular_velocity: 2;"},
    {"centerOfMass", "center_of_mass: [0, 0, -0.01]", "center_of_mass: [0, 0, 1e10]", "bodies[0].center_of_mass: [0, 0, 1e+10];"},
    {"friction", "friction: 0.3", "friction: -0.1", "bodies[0].friction: -0.1;"},
    {"linearDamping", "linear_damping: 0.01", "linear_damping: -1", "bodies[0].linear_damping: -1; allowed: 0 or more [N s/m]"},
    {"angularDamping", "angular_damping: 0.001", "angular_damping: -1",
     "bodies[0].angular_damping: -1; allowed: 0 or more [N m s]"},
    {"bodyNamedLikeACable", "name: wheel", "name: rope",
     "bodies[1].name: \"rope\"; allowed: a name that is used once; it is cables[0].name"},
    {"bodyTwice", "name: wheel", "name: hook",
     "bodies[1].name: \"hook\"; allowed: a name that is used once; it is bodies[0].name"},
    {"attachmentTwice", "name: stay", "name: top", "bodies[1].attachments[1].name: \"top\"; allowed: a name that is used once"},
    {"attachmentWithoutName", "name: stay, ", "", "bodies[1].attachments[1].name: missing;"},
    {"unknownBodyOfACable", "body: hook, offset", "body: hock, offset",
     "cables[0].attachments[1].body: \"hock\"; allowed: a body of the scene (hook, wheel)"},
    {"unknownBodyOfABody", "name: stay, body: hook", "name: stay, body: nothing",
     "bodies[1].attachments[1].body: \"nothing\"; allowed: a body of the scene (hook, wheel)"},
    {"heldByItself", "name: stay, body: hook", "name: stay, body: wheel",
     "bodies[1].attachments[1].body: \"wheel\"; allowed: another body, or a frame"},
    {"bodyAndFrame", "body: hook, offset", "body: hook, frame: arm, offset",
     "cables[0].attachments[1].body: \"hook\", given together with frame \"arm\"; allowed: one of the two"},
    {"bodyWithInitialPose", "body: hook, offset", "body: hook, initial_pose: [0, 0, 0, 0, 0, 0], offset",
     "cables[0].attachments[1].initial_pose: given together with body \"hook\";"},
    {"axleOfACable", "rotation: [0, 0, 1], type: clamp", "type: axle",
     "cables[0].attachments[1].type: \"axle\"; allowed: hinge | clamp"},
    {"twoClamps",
     "type: axle, at: [0, 0, 0.01, 0, 0, 0], offset: [1, 0, 0], rotation: [0, 0, 0.5], initial_pose: [0, 0, 3, 0, 0, 0]}\n      "
     "- {name: stay, body: hook",
     "type: clamp}\n      - {name: stay, type: clamp, body: hook",
     "bodies[1].attachments[1].type: clamp; allowed: nothing besides \"bearing\", a clamp, which holds the whole body"},
    {"axleAndClamp", "name: stay, body: hook", "name: stay, type: clamp, body: hook",
     "bodies[1].attachments[0].type: axle; allowed: nothing besides \"stay\", a clamp, which holds the whole body"},
    {"twoAxles", "name: stay, body: hook", "name: stay, type: axle, body: hook",
     "bodies[1].attachments[1].type: axle; allowed: a hinge on the axis of \"bearing\", an axle"},
    {"place", "at: [0, 0, 0.01, 0, 0, 0]", "at: end", "bodies[1].attachments[0].at: \"end\"; allowed: six numbers"},
    {"frameWithSlash", "frame: arm", "frame: /arm", "bodies[1].attachments[0].frame: \"/arm\";"},
    {"otherInitialPose", "offset: [0, 0, 2]}", "frame: arm, initial_pose: [0, 0, 2, 0, 0, 0]}",
     "bodies[1].attachments[0].initial_pose: [0, 0, 3, 0, 0, 0]; allowed: the same initial_pose wherever a frame is named"},
    {"broadcast", "broadcast_tf: true", "broadcast_tf: sometimes", "broadcast_tf: \"sometimes\"; allowed: true | false"},
};
INSTANTIATE_TEST_SUITE_P(BodyKeys, BodyKeysMistake, testing::ValuesIn(mistakes),
                         [](const auto& instance) { return std::string(instance.param.name); });

TEST(BodyKeys, allMistakesAreNamedAtOnce) {
  const auto errors = errors_of(R"(
bodies:
  - {name: a, mass: -1, inertia: [1, 0.1, 0.1]}
  - {name: b, mass: 1}
  - {name: c, mass: 1, inertia: [1, 1, 1], attachments: [{name: one, type: clamp}, {name: two, type: clamp}]}
)");
  EXPECT_EQ(errors.size(), 4u) << joined(errors);
  for (const char* line : {"bodies[0].mass: -1;", "bodies[0].inertia: [1, 0.1, 0.1];", "bodies[1].inertia: missing;",
                           "bodies[2].attachments[1].type: clamp;"})
    EXPECT_TRUE(has_line(errors, line)) << line;
}

}  // namespace
}  // namespace verlet_cable

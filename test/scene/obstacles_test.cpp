#include <gtest/gtest.h>

#include <fstream>
#include <regex>

#include "scene_text.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {
namespace {

using test::errors_of;
using test::has_line;
using test::joined;
using test::sound_scene;

TEST(Obstacles, everyKeyIsRead) {
  const SceneDesc scene = read_scene_text(sound_scene + R"(
obstacles:
  - {name: floor, type: plane, frame: world, friction: 0.6}
  - {name: ball, type: sphere, frame: hand, pose: [1, 2, 3, 0.1, 0.2, 0.3], radius: 0.1}
  - {name: pill, type: capsule, radius: 0.1, length: 0.2, frame: other, initial_pose: [6, 5, 4, 3, 2, 1]}
  - {name: pole, type: cylinder, radius: 0.3, length: "4e-1"}
  - {name: crate, type: box, size: [1, 2, 3]}
contact: {self: false, between_cables: true, friction: 0.2}
scene_directory: /somewhere
color_by: contact
)");
  ASSERT_EQ(scene.obstacles.size(), 5u);
  EXPECT_EQ(scene.obstacles[0].type, ShapeType::plane);
  EXPECT_EQ(scene.obstacles[0].friction, 0.6);
  EXPECT_FALSE(scene.obstacles[1].friction);
  EXPECT_EQ(scene.obstacles[1].frame, "hand");
  EXPECT_EQ(scene.obstacles[1].pose, (InitialPose{1, 2, 3, 0.1, 0.2, 0.3}));
  EXPECT_EQ(scene.obstacles[1].radius, 0.1);
  EXPECT_EQ(scene.obstacles[2].type, ShapeType::capsule);
  EXPECT_EQ(scene.obstacles[2].length, 0.2);
  EXPECT_EQ(scene.obstacles[2].initial_pose, (InitialPose{6, 5, 4, 3, 2, 1}));
  EXPECT_EQ(scene.obstacles[3].length, 0.4);
  EXPECT_EQ(scene.obstacles[4].size, Vector3(1, 2, 3));
  EXPECT_FALSE(scene.contact->self);
  EXPECT_TRUE(scene.contact->between_cables);
  EXPECT_EQ(scene.contact->friction, 0.2);
  EXPECT_EQ(scene.scene_directory, "/somewhere");
  EXPECT_EQ(scene.color_by, ColorBy::contact);
  EXPECT_EQ(frame_names(scene), (std::vector<std::string>{"world", "hand", "other"}));
}

TEST(Obstacles, contactHasDefaults) {
  const SceneDesc scene = read_scene_text(sound_scene + "contact: {}\n");
  EXPECT_TRUE(scene.contact->self);
  EXPECT_TRUE(scene.contact->between_cables);
  EXPECT_EQ(scene.contact->friction, 0.3);
  EXPECT_FALSE(read_scene_text(sound_scene).contact);
}

struct Mistake {
  const char* name;
  const char* obstacle;
  const char* error;
};
void PrintTo(const Mistake& mistake, std::ostream* stream) {
  *stream << mistake.name;
}

class ObstacleMistake : public testing::TestWithParam<Mistake> {};

TEST_P(ObstacleMistake, isTheOneErrorAndNamed) {
  const std::string mesh = testing::TempDir() + "triangle.obj";
  std::ofstream(mesh) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const std::string obstacle = std::regex_replace(GetParam().obstacle, std::regex("TRIANGLE"), "file://" + mesh);
  const std::vector<std::string> errors = errors_of(sound_scene + "obstacles: [{name: floor, type: plane}, " + obstacle + "]\n");
  EXPECT_TRUE(has_line(errors, GetParam().error)) << joined(errors);
  EXPECT_EQ(errors.size(), 1u) << joined(errors);
}

const Mistake mistakes[] = {
    {"noName", "{type: plane}", "obstacles[1].name: missing;"},
    {"sameName", "{name: floor, type: plane}", "obstacles[1].name: \"floor\"; allowed: a name that is used once;"},
    {"badName", "{name: 1st, type: plane}", "obstacles[1].name: \"1st\";"},
    {"noType", "{name: a, radius: 1}", "obstacles[1].type: missing; allowed: plane | sphere | capsule | cylinder | box | mesh"},
    {"unknownType", "{name: a, type: cone, radius: 1}", "obstacles[1].type: \"cone\"; allowed: plane | sphere |"},
    {"unknownKey", "{name: a, type: plane, hight: 1}", "obstacles[1].hight: unknown key,"},
    {"noRadius", "{name: a, type: sphere}", "obstacles[1].radius: missing;"},
    {"negativeRadius", "{name: a, type: sphere, radius: -0.1}", "obstacles[1].radius: -0.1; allowed: any number above 0 [m]"},
    {"zeroLength", "{name: a, type: capsule, radius: 1, length: 0}", "obstacles[1].length: 0;"},
    {"nanLength", "{name: a, type: cylinder, radius: 1, length: .nan}", "obstacles[1].length: \".nan\";"},
    {"infiniteSize", "{name: a, type: box, size: [1, .inf, 1]}", "obstacles[1].size: [1, inf, 1];"},
    {"negativeSize", "{name: a, type: box, size: [1, -1, 1]}", "obstacles[1].size: [1, -1, 1];"},
    {"sizeOfASphere", "{name: a, type: sphere, radius: 1, size: [1, 1, 1]}", "obstacles[1].size: given with another type;"},
    {"nanPose", "{name: a, type: plane, pose: [0, 0, .nan, 0, 0, 0]}", "obstacles[1].pose: [0, 0, .nan, 0, 0, 0];"},
    {"farPose", "{name: a, type: plane, pose: [0, 0, 1e300, 0, 0, 0]}", "obstacles[1].pose: [0, 0, 1e+300, 0, 0, 0];"},
    {"shortPose", "{name: a, type: plane, pose: [0, 0, 0]}", "obstacles[1].pose: [0, 0, 0]; allowed: six numbers"},
    {"negativeFriction", "{name: a, type: plane, friction: -1}", "obstacles[1].friction: -1;"},
    {"frameWithSlash", "{name: a, type: plane, frame: /hand}", "obstacles[1].frame: \"/hand\";"},
    {"poseOfTheFixedFrame", "{name: a, type: plane, initial_pose: [1, 0, 0, 0, 0, 0]}", "obstacles[1].initial_pose: [1, 0, 0,"},
    {"anotherPoseOfTheHand", "{name: a, type: plane, frame: hand, initial_pose: [1, 0, 0, 0, 0, 0]}",
     "obstacles[1].initial_pose: [1, 0, 0, 0, 0, 0]; allowed: the same initial_pose wherever a frame is named; \"hand\" has "
     "[0.7, 0, 0, 0, 0, 0] by "
     "cables[0].attachments[1].initial_pose"},
    {"noUri", "{name: a, type: mesh}", "obstacles[1].uri: missing;"},
    {"noSuchMesh", "{name: a, type: mesh, uri: \"file:///nonexistent.stl\"}",
     "obstacles[1].uri: \"file:///nonexistent.stl\": No such file or directory; allowed: a file with a mesh"},
    {"relativeUri", "{name: a, type: mesh, uri: \"file://a.stl\"}",
     "obstacles[1].uri: \"file://a.stl\": its path does not start with /;"},
    {"meshFromTheWeb", "{name: a, type: mesh, uri: \"http://a/b.stl\"}",
     "obstacles[1].uri: \"http://a/b.stl\": it names no file;"},
    {"directoryAsMesh", "{name: a, type: mesh, uri: \"file:///tmp\"}", "obstacles[1].uri: \"file:///tmp\": it is not a file;"},
    {"endlessMesh", "{name: a, type: mesh, uri: \"file:///dev/zero\"}",
     "obstacles[1].uri: \"file:///dev/zero\": it is not a file;"},
    {"unknownPackage", "{name: a, type: mesh, uri: \"package://no_such_package/a.stl\"}",
     "obstacles[1].uri: \"package://no_such_package/a.stl\": package \"no_such_package\" is not found in ROS_PACKAGE_PATH;"},
    {"zeroScale", "{name: a, type: mesh, uri: \"file:///a.stl\", scale: 0}", "obstacles[1].scale: [0, 0, 0];"},
    {"unknownSheet", "{name: a, type: mesh, uri: \"TRIANGLE\", sheet: both}",
     "obstacles[1].sheet: \"both\"; allowed: auto | true | false"},
    {"negativeThickness", "{name: a, type: mesh, uri: \"TRIANGLE\", thickness: -1}", "obstacles[1].thickness: -1;"},
    {"sheetOfABox", "{name: a, type: box, size: [1, 1, 1], sheet: true}", "obstacles[1].sheet: given with another type;"},
};

INSTANTIATE_TEST_SUITE_P(Each, ObstacleMistake, testing::ValuesIn(mistakes),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(Obstacles, mistakesOfContactAreNamed) {
  EXPECT_TRUE(has_line(errors_of(sound_scene + "contact: {self: 1}\n"), "contact.self: 1; allowed: true | false"));
  EXPECT_TRUE(has_line(errors_of(sound_scene + "contact: {friction: -1}\n"), "contact.friction: -1;"));
  EXPECT_TRUE(has_line(errors_of(sound_scene + "contact: {other: true}\n"), "contact.other: unknown key"));
  EXPECT_TRUE(has_line(errors_of(sound_scene + "contact: everything\n"), "contact: \"everything\";"));
  EXPECT_TRUE(has_line(errors_of(sound_scene + "obstacles: {floor: plane}\n"), "obstacles: {floor: plane}; allowed: a list"));
}

TEST(Obstacles, thoseOfTheWorldFollowTheirFrames) {
  const SceneDesc scene = read_scene_text(sound_scene + R"(
obstacles:
  - {name: floor, type: plane, pose: [0, 0, -1, 0, 0, 0]}
  - {name: late, type: sphere, radius: 0.1, frame: cart}
)");
  BoundaryInputs inputs = initial_frames(scene);
  World world(scene, inputs);
  ASSERT_EQ(world.obstacles().size(), 2u);
  EXPECT_TRUE(world.findings().waiting.empty());
  EXPECT_TRUE(world.obstacles()[0].present);
  EXPECT_TRUE(world.obstacles()[0].holders.empty());
  EXPECT_EQ(world.obstacles()[0].pose.position, Vector3(0, 0, -1));
  EXPECT_FALSE(world.obstacles()[1].present);
  world.step(inputs);
  EXPECT_FALSE(world.obstacles()[1].present);
  const int cart = world.obstacles()[1].frame;
  EXPECT_EQ(world.obstacles()[1].holders, std::vector<int>{cart});
  inputs[cart] = {{{1, 2, 3}, Quaternion::Identity()}, true};
  world.step(inputs);
  EXPECT_TRUE(world.obstacles()[1].present);
  EXPECT_EQ(world.frame_pose(cart).position, Vector3(1, 2, 3));
}

TEST(Obstacles, areAddedReplacedAndRemoved) {
  const SceneDesc scene = read_scene_text(sound_scene);
  World world(scene, initial_frames(scene));
  const std::uint64_t before = world.hash();
  Obstacle ball{"ball", 0, {{1, 0, 0}, Quaternion::Identity()}, SphereShape{0.1}, std::nullopt, 0, {}, false};
  EXPECT_TRUE(world.apply(edit::SetObstacle{ball}).ok);
  EXPECT_NE(world.hash(), before);
  ball.shape = BoxShape{{1, 1, 1}};
  EXPECT_TRUE(world.apply(edit::SetObstacle{ball}).ok);
  ASSERT_EQ(world.obstacles().size(), 1u);
  EXPECT_TRUE(std::holds_alternative<BoxShape>(world.obstacles()[0].shape));

  Obstacle bad = ball;
  bad.shape = SphereShape{-1};
  EXPECT_EQ(world.apply(edit::SetObstacle{bad}).message.find("obstacle \"ball\": radius: -1; allowed: any number above 0"), 0u);
  bad = ball;
  bad.pose.position.y() = infinity;
  EXPECT_FALSE(world.apply(edit::SetObstacle{bad}).ok);
  bad = ball;
  bad.frame = 7;
  EXPECT_FALSE(world.apply(edit::SetObstacle{bad}).ok);
  bad = ball;
  bad.shape = MeshShape{};
  EXPECT_FALSE(world.apply(edit::SetObstacle{bad}).ok);
  EXPECT_TRUE(std::holds_alternative<BoxShape>(world.obstacles()[0].shape));

  EXPECT_FALSE(world.apply(edit::RemoveObstacle{"box"}).ok);
  EXPECT_TRUE(world.apply(edit::RemoveObstacle{"ball"}).ok);
  EXPECT_EQ(world.hash(), before);

  // A frame that nothing has said anything about yet.
  ball.frame = world.add_frame("camera", std::nullopt);
  EXPECT_TRUE(world.apply(edit::SetObstacle{ball}).ok);
  EXPECT_FALSE(world.obstacles()[0].present);
  EXPECT_FALSE(world.frame_known(ball.frame));
}

}  // namespace
}  // namespace verlet_cable

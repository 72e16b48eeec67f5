#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "../support/meshes.h"
#include "scene/frame_source.h"
#include "scene_text.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {
namespace {

using test::errors_of;
using test::has_line;
using test::joined;
using test::replaced;
using test::sound_scene;

// base -(revolute, up 0.5)- arm -(fixed, out 0.4)- tool, and a wheel beside the base.
const std::string urdf = R"(<robot name="r">
  <link name="base">
    <collision><origin xyz="0 0 0.1"/><geometry><box size="0.2 0.4 0.6"/></geometry></collision>
    <collision><geometry><cylinder radius="0.3" length="0.7"/></geometry></collision>
    <collision><geometry><sphere radius="0.05"/></geometry></collision>
  </link>
  <link name="arm"><collision><origin rpy="0 1.5 0"/><geometry><mesh filename="MESH" scale="2 3 4"/></geometry></collision></link>
  <link name="tool"/>
  <link name="base_1"><collision><geometry><sphere radius="0.06"/></geometry></collision></link>
  <joint name="j1" type="revolute"><parent link="base"/><child link="arm"/><origin xyz="0 0 0.5" rpy="0 0 1.5707963267948966"/>
    <axis xyz="0 0 1"/><limit effort="1" velocity="1" lower="-1" upper="1"/></joint>
  <joint name="j2" type="fixed"><parent link="arm"/><child link="tool"/><origin xyz="0.4 0 0"/></joint>
  <joint name="j3" type="fixed"><parent link="base"/><child link="base_1"/></joint>
</robot>)";

std::string stl_of(const Triangles& mesh) {
  std::ostringstream text;
  text << "solid m\n";
  for (const auto& triangle : mesh.triangles) {
    text << "facet normal 0 0 0\nouter loop\n";
    for (const int i : triangle) text << "vertex " << mesh.vertices[i].transpose() << "\n";
    text << "endloop\nendfacet\n";
  }
  text << "endsolid m\n";
  return text.str();
}

class Robot : public testing::Test {
 protected:
  Robot() {
    std::string pattern = testing::TempDir() + "robot_XXXXXX";
    directory_ = mkdtemp(pattern.data());
    write("box.stl", stl_of(box_triangles({1, 1, 1})));
    write("robot.urdf", replaced(urdf, "MESH", "file://" + path("box.stl")));
  }
  ~Robot() override { std::filesystem::remove_all(directory_); }

  std::string path(const std::string& name) const { return directory_ + "/" + name; }
  void write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories(std::filesystem::path(path(name)).parent_path());
    std::ofstream(path(name)) << text;
  }
  SceneDesc read(const std::string& robot, const std::string& attachment_frame = "hand") const {
    return read_scene_text(replaced(sound_scene, "frame: hand", "frame: " + attachment_frame) + "robot: " + robot + "\n");
  }
  std::string file() const { return "file: " + path("robot.urdf"); }

  std::string directory_;
};

TEST_F(Robot, collisionGeometryOfAllLinksBecomesObstacles) {
  const SceneDesc scene = read("{" + file() + ", padding: 0.01}");
  const std::vector<ObstacleDesc> obstacles = all_obstacles(scene);
  std::vector<std::string> names;
  for (const ObstacleDesc& obstacle : obstacles) {
    names.push_back(obstacle.name);
    EXPECT_EQ(obstacle.padding, 0.01);
  }
  // base_1 is a link: the second obstacle of base cannot have its name.
  EXPECT_EQ(names, (std::vector<std::string>{"base", "base_2", "base_3", "arm", "base_1"}));
  EXPECT_EQ(obstacles[0].type, ShapeType::box);
  EXPECT_EQ(obstacles[0].size, Vector3(0.2, 0.4, 0.6));
  EXPECT_EQ(obstacles[0].pose[2], 0.1);
  EXPECT_EQ(obstacles[1].type, ShapeType::cylinder);
  EXPECT_EQ(obstacles[1].radius, 0.3);
  EXPECT_EQ(obstacles[1].length, 0.7);
  EXPECT_EQ(obstacles[2].radius, 0.05);
  EXPECT_EQ(obstacles[3].frame, "arm");
  EXPECT_NEAR(obstacles[3].pose[4], 1.5, 1e-12);
  EXPECT_EQ(obstacles[3].mesh->bounds().sizes(), Vector3(2, 3, 4));
}

TEST_F(Robot, linksAreSelected) {
  const SceneDesc scene = read("{" + file() + ", links: [tool, base_1]}");
  ASSERT_EQ(all_obstacles(scene).size(), 1u);
  EXPECT_EQ(all_obstacles(scene)[0].name, "base_1");
  EXPECT_EQ(scene.robot->tree.size(), 4u);
}

TEST_F(Robot, obstaclesBelongToTheFramesThatAreRigidlyJoined) {
  const SceneDesc scene = read("{" + file() + "}", "tool");
  const World world(scene, initial_frames(scene));
  const auto id = [&](const std::string& name) {
    return static_cast<int>(std::find(world.frames().begin(), world.frames().end(), name) - world.frames().begin());
  };
  EXPECT_EQ(world.frames(), (std::vector<std::string>{"world", "tool", "base", "arm", "base_1"}));
  EXPECT_EQ(world.obstacles()[3].name, "arm");
  EXPECT_EQ(world.obstacles()[3].holders, (std::vector<int>{id("tool"), id("arm")}));
  EXPECT_EQ(world.obstacles()[0].holders, (std::vector<int>{id("base"), id("base_1")}));
}

TEST_F(Robot, linksOfCableSimAreAtZeroOrWhereTheMotionHasTheirParents) {
  SceneDesc scene = read("{" + file() + "}", "hand");
  scene.cables[0].attachments[1].frame = "tool";
  scene.cables[0].attachments[1].initial_pose.reset();
  const auto at = [&](const Motion& motion, const std::string& name) {
    const std::vector<std::string> names = frame_names(scene);
    return FrameSource(scene, motion).at(0)[std::find(names.begin(), names.end(), name) - names.begin()].pose;
  };
  // The joint turns the arm's x into the base's y.
  EXPECT_LT((at({}, "tool").position - Vector3(0, 0.4, 0.5)).norm(), 1e-12);
  EXPECT_EQ(at({}, "arm").position, Vector3(0, 0, 0.5));
  FrameTrack moved;
  moved.add(0, {{1, 0, 0}, Quaternion::Identity()});
  EXPECT_LT((at({{"base", moved}}, "tool").position - Vector3(1, 0.4, 0.5)).norm(), 1e-12);
  EXPECT_LT((at({{"arm", moved}}, "tool").position - Vector3(1.4, 0, 0)).norm(), 1e-12);
  EXPECT_EQ(at({{"tool", moved}}, "tool").position, Vector3(1, 0, 0));
  EXPECT_TRUE(unused_frames(scene, {{"base", moved}}).empty());
}

TEST_F(Robot, bytesOfOtherFramesAndLinksAreRefused) {
  SceneDesc scene = read("{" + file() + "}", "hand");
  FrameTrack moved;
  moved.add(0, {{1, 0, 0}, Quaternion::Identity()});
  ByteWriter written;
  FrameSource(scene, {{"base", moved}}).write(written);
  const std::string bytes = written.take();
  const std::size_t ids = frame_names(scene).size();
  const auto place_of_last = [ids](const std::string& from, std::size_t most_ids) {
    ByteReader reader(from);
    return FrameSource(reader, most_ids).at(0).at(ids - 1).pose.position;
  };
  const Vector3 as_written = place_of_last(bytes, ids);
  EXPECT_EQ(place_of_last(bytes, ids + 3), as_written);
  EXPECT_THROW(place_of_last(bytes, ids - 1), std::invalid_argument);
  // Any four bytes that are taken for an index are refused, or are none.
  for (std::size_t at = 0; at + sizeof(int) <= bytes.size(); ++at) {
    for (const int index : {-2, 1000}) {
      std::string forged = bytes;
      std::memcpy(&forged[at], &index, sizeof index);
      try {
        EXPECT_TRUE(place_of_last(forged, ids).allFinite()) << at;
      } catch (const std::invalid_argument&) {
      }
    }
  }
  const std::size_t first_id = sizeof(double) + sizeof(int) + sizeof(std::size_t);
  std::string forged = bytes;
  forged[first_id] = 100;
  EXPECT_THROW(place_of_last(forged, ids), std::invalid_argument);
}

TEST_F(Robot, aLinkWithAGivenPoseCarriesThoseAfterIt) {
  SceneDesc scene = read("{" + file() + "}", "hand");
  scene.cables[0].attachments[1].frame = "tool";
  scene.cables[0].attachments[1].initial_pose.reset();
  const std::vector<std::string> names = frame_names(scene);
  const auto id = [&](const std::string& name) {
    return static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
  };
  FrameSource frames(scene, {});
  const Pose given{{1, 0, 0}, Quaternion::Identity()};
  EXPECT_LT((frames.at(0, {{id("arm"), given}})[id("tool")].pose.position - Vector3(1.4, 0, 0)).norm(), 1e-12);
  EXPECT_EQ(frames.at(0, {{id("tool"), given}})[id("tool")].pose.position, given.position);
  const int later = static_cast<int>(names.size()) + 2;
  frames.add("camera", later, given);
  const BoundaryInputs inputs = frames.at(0);
  ASSERT_EQ(inputs.size(), names.size() + 3);
  EXPECT_EQ(inputs[later].pose.position, given.position);
  EXPECT_FALSE(inputs[later - 1].known) << "another's";
}

TEST_F(Robot, aParameterComesBeforeTheFile) {
  SceneSources sources;
  std::string asked;
  sources.parameter = [&](const std::string& name) -> std::optional<std::string> {
    asked = name;
    return "<robot name='p'><link name='only'/></robot>";
  };
  const SceneDesc scene = read_scene_text(sound_scene + "robot: {description: arm_description, " + file() + "}\n", sources);
  EXPECT_EQ(asked, "arm_description");
  EXPECT_EQ(scene.robot->tree.size(), 1u);
  sources.parameter = [](const std::string&) { return std::nullopt; };
  try {
    read_scene_text(sound_scene + "robot: {description: arm_description}\n", sources);
    ADD_FAILURE() << "not refused";
  } catch (const SceneError& error) {
    EXPECT_TRUE(has_line(error.errors(),
                         "robot.description: \"arm_description\" is not set, or is no text; allowed: a parameter with a URDF"));
  }
  EXPECT_EQ(read_scene_text(sound_scene + "robot: {" + file() + "}\n", sources).robot->tree.size(), 4u);
}

TEST_F(Robot, mistakesAreNamed) {
  const auto errors = [&](const std::string& robot) { return errors_of(sound_scene + "robot: " + robot + "\n"); };
  const auto expect = [&](const std::string& robot, const std::string& error) {
    const std::vector<std::string> lines = errors(robot);
    EXPECT_TRUE(has_line(lines, error)) << joined(lines);
    EXPECT_EQ(lines.size(), 1u) << joined(lines);
  };
  expect("{}", "robot.file: missing; allowed: a file with a URDF");
  expect("{file: /nonexistent.urdf}", "robot.file: \"/nonexistent.urdf\": No such file or directory; allowed: a URDF");
  expect("{" + file() + ", links: []}", "robot.links: []; allowed: all, or a list of at least one link");
  expect("{" + file() + ", links: [base, elbow]}",
         "robot.links[1]: \"elbow\"; allowed: a link of the robot: base, arm, tool, base_1");
  expect("{" + file() + ", padding: -0.1}", "robot.padding: -0.1;");
  expect("{" + file() + "}\nobstacles: [{name: arm, type: plane}]",
         "robot.arm: \"arm\"; allowed: a name that is used once; it is obstacles[0].name already");
  write("text.urdf", "no robot at all");
  expect("{file: " + path("text.urdf") + "}", "robot.file: \"" + path("text.urdf") + "\": no URDF: ");
  write("loop.urdf",
        "<robot name='r'><link name='a'/><joint name='j' type='fixed'><parent link='a'/><child link='b'/></joint></robot>");
  expect("{file: " + path("loop.urdf") + "}", "robot.file: \"" + path("loop.urdf") + "\": no URDF: ");
  write("nan.urdf", replaced(urdf, "0.2 0.4 0.6", "0.2 nan 0.6"));
  expect("{file: " + path("nan.urdf") + "}", "robot.file: \"" + path("nan.urdf") + "\": no URDF: ");
  write("robot.urdf", replaced(urdf, "MESH", "package://none/a.stl"));
  expect("{" + file() + ", on_bad_mesh: error}", "robot.arm.uri: \"package://none/a.stl\": package \"none\" is not found");
  expect("{" + file() + ", on_bad_mesh: stop}", "robot.on_bad_mesh: \"stop\"; allowed: warn | error");
  expect("{" + file() + ", geometry: all}", "robot.geometry: \"all\"; allowed: collision | visual | collision_or_visual");
  expect("{" + file() + ", links: [base]}\nseed: -1", "seed: -1");  // what is not selected is not read
}

TEST_F(Robot, whatIsTooDeepOrTooLongForTheParserIsNamed) {
  const auto expect = [&](const std::string& text, const std::string& error) {
    write("bad.urdf", text);
    const std::vector<std::string> lines = errors_of(sound_scene + "robot: {file: " + path("bad.urdf") + "}\n");
    EXPECT_EQ(lines.size(), 1u) << joined(lines);
    EXPECT_TRUE(has_line(lines, "robot.file: \"" + path("bad.urdf") + "\": no URDF: " + error)) << joined(lines);
  };
  const auto link = [](int i) { return "<link name='l" + std::to_string(i) + "'/>"; };
  std::string chain = "<robot name='r'>" + link(0);
  for (int i = 1; i < 20'000; ++i)
    chain += link(i) + "<joint name='j" + std::to_string(i) + "' type='fixed'><parent link='l" + std::to_string(i - 1) +
             "'/><child link='l" + std::to_string(i) + "'/></joint>";
  expect(chain + "</robot>", "20000 links, more than 1000");
  std::string nested = "<robot name='r'>", hidden = nested, misread = nested;
  for (int i = 0; i < 100'000; ++i) {
    nested += "<a>";
    if (i < 20'000) hidden += "<a b='>' c=\"'/>\">text<!-- </a> --><![CDATA[</a>]]>";
    misread += "<a>\xf0</a>";  // where a parser skips four bytes for the first, `a` is never closed
  }
  expect(nested, "100001 levels of nested elements, more than 64");
  expect(hidden, "20001 levels of nested elements, more than 64");
  expect(misread, "byte 19: no text in UTF-8");
  expect("<robot name='r'><?x ></a>?></robot>", "byte 16: a processing instruction that does not end with its first >");
  expect("<robot name='r'><a <b></robot>", "byte 19: a < inside of a tag");
  expect("<robot name='r'>1 < 2</robot>", "byte 18: a < that starts no tag");
  expect("<!DOCTYPE r [<!ENTITY a '&b;&b;'>]><robot name='r'/>", "byte 0: a document type with definitions");
  expect("<robot name='r'><link name='" + std::string(1001, 'l') + "'/></robot>", "link \"lll");
  expect("<robot name='r'/>" + std::string(5'000'000, ' '), "5000017 bytes, more than 4194304");
}

/// The parser compares each attribute of an element with all before it: many take minutes.
TEST_F(Robot, elementsWithTooManyAttributesAreNamed) {
  const auto errors = [&](const std::string& attribute, int count) {
    std::string text = "<robot name='r'><!-- a=1 --><link name='a'/><x";
    for (int i = 0; i < count; ++i) text += " x" + std::to_string(i) + attribute;
    write("bad.urdf", text + "/></robot>");
    return joined(errors_of(sound_scene + "robot: {file: " + path("bad.urdf") + "}\n"));
  };
  // Signs in values are no attributes.
  EXPECT_EQ(errors("='= \" ='", 1000), "");
  for (const char* attribute : {"='1'", " =\n\"=\"", "=1"})
    EXPECT_NE(errors(attribute, 30'000).find("bad.urdf\": no URDF: 30000 attributes on one element, more than 1000"),
              std::string::npos)
        << attribute;
}

TEST_F(Robot, tooManyCollisionsAreNamed) {
  const auto link = [](const std::string& name, int collisions) {
    std::string text = "<link name='" + name + "'>";
    for (int i = 0; i < collisions; ++i) text += "<collision><geometry><sphere radius='1'/></geometry></collision>";
    return text + "</link>";
  };
  const std::string joint = "<joint name='j' type='fixed'><parent link='a'/><child link='b'/></joint>";
  write("many.urdf", "<robot name='r'>" + link("a", 5000) + link("b", 1) + joint + "</robot>");
  const auto errors = [&](const std::string& links) {
    return joined(errors_of(sound_scene + "robot: {file: " + path("many.urdf") + links + "}\n"));
  };
  EXPECT_NE(errors("").find("many.urdf\": no URDF: 5001 collisions, more than 5000"), std::string::npos) << errors("");
  EXPECT_NE(errors(", links: [b, a]").find("no URDF: 5001 collisions of the links in robot.links, more than 5000"),
            std::string::npos);
  EXPECT_EQ(errors(", links: [a]"), "");
}

TEST_F(Robot, namesOfLinksAreNotEmptyAndGivenOnce) {
  const auto expect = [&](const std::string& robot, const std::string& error) {
    const std::vector<std::string> lines = errors_of(sound_scene + "robot: {" + robot + "}\n");
    EXPECT_EQ(lines.size(), 1u) << joined(lines);
    EXPECT_TRUE(has_line(lines, error)) << joined(lines);
  };
  expect(file() + ", links: [tool, base, tool]", "robot.links[2]: \"tool\" given twice; allowed: each link once");
  write("bad.urdf", "<robot name='r'><link name=''/></robot>");
  expect("file: " + path("bad.urdf"), "robot.file: \"" + path("bad.urdf") + "\": no URDF: a link with the name \"\"");
}

/// urdfdom prints numbers that it cannot read as formats: `%n` writes to memory, `%s` reads from it.
TEST_F(Robot, percentSignsAreNoFormats) {
  const auto problem = [&](const std::string& from, const std::string& to) {
    write("bad.urdf", replaced(urdf, from, to));
    const std::vector<std::string> lines = errors_of(sound_scene + "robot: {links: [base], file: " + path("bad.urdf") + "}\n");
    const std::string start = "robot.file: \"" + path("bad.urdf") + "\": no URDF: ";
    EXPECT_EQ(lines.size(), 1u) << joined(lines);
    return lines.size() == 1 && lines[0].rfind(start, 0) == 0 ? lines[0].substr(start.size()) : joined(lines);
  };
  for (const char* number : {"0 0 0.1", "0.2 0.4 0.6", "0.3", "0.7", "0.05"})
    EXPECT_NE(problem('"' + std::string(number) + '"', "\"%n%n%s%s%s%n%n 0 0\"").find("%n%n%s%s%s%n%n"), std::string::npos)
        << number;
  for (const char* reference : {"&#37;n", "&#0037;n", "&#x25;n", "&#x125;n", "&#293;n"})
    EXPECT_NE(problem("0.2 0.4 0.6", reference).find(": a reference to the character %"), std::string::npos) << reference;
  for (const char* reference : {"&#x100000025;n", "&#n", "&#37", "&#;", "&#x;", "&#-219;"})
    EXPECT_NE(problem("0.2 0.4 0.6", reference).find(": a reference to no character"), std::string::npos) << reference;
  EXPECT_NE(problem("0.2 0.4 0.6", "\x1fn").find(": a control character"), std::string::npos);
}

TEST_F(Robot, percentSignsStayWhatTheyAre) {
  write("50%20.stl", stl_of(box_triangles({1, 1, 1})));
  write("good.urdf", replaced(replaced(urdf, "MESH", "file://" + path("50%20.stl")), "<robot name=\"r\">",
                              "<robot name=\"50 %n\"><!-- 50 % &#45;&#10; -->"));
  const SceneDesc scene = read("{file: " + path("good.urdf") + "}");
  ASSERT_EQ(all_obstacles(scene).size(), 5u);
  EXPECT_EQ(all_obstacles(scene)[3].uri, "file://" + path("50%20.stl"));
}

TEST_F(Robot, markupThatIsNoElementDoesNotCount) {
  std::string text = "<?xml version='1.0' encoding='UTF-8'?><!DOCTYPE robot><!-- a > b <c> -->";
  text += "<robot name=\"caf\u00e9 > a\"><!-- <a><b>'\" --><link name='one'><x><![CDATA[<a><b></x>]]></x></link>";
  for (int i = 0; i < 1000; ++i)
    text += "<!-- <a> --><material name='a" + std::to_string(i) + "'><color rgba='1 1 1 1'/></material>";
  write("good.urdf", text + "</robot>");
  const SceneDesc scene = read("{file: " + path("good.urdf") + "}");
  EXPECT_EQ(scene.robot->tree.size(), 1u);
}

TEST_F(Robot, meshesWithoutTrianglesAreNamed) {
  const auto expect = [&](const std::string& name, const std::string& error) {
    const auto lines = errors_of(sound_scene + "obstacles: [{name: a, type: mesh, uri: \"file://" + path(name) + "\"}]\n");
    EXPECT_EQ(lines.size(), 1u) << joined(lines);
    EXPECT_TRUE(has_line(lines, "obstacles[0].uri: \"file://" + path(name) + "\": " + error)) << joined(lines);
  };
  write("empty.stl", "solid m\nendsolid m\n");
  expect("empty.stl", "no mesh: ");
  write("text.stl", "no mesh at all");
  expect("text.stl", "no mesh: ");
  write("zero.obj", "");
  expect("zero.obj", "no mesh: ");
}

TEST_F(Robot, badGeometryIsLeftOutAndNamed) {
  write("empty.stl", "solid m\nendsolid m\n");
  const auto with = [&](const std::string& geometry) {
    write("bad.urdf",
          "<robot name='r'><link name='base'><collision><geometry><sphere radius='1'/></geometry></collision>"
          "<collision><geometry>" +
              geometry + "</geometry></collision></link></robot>");
  };
  const auto mesh = [&](const std::string& name, const std::string& scale) {
    return "<mesh filename='file://" + path(name) + "' scale='" + scale + "'/>";
  };
  for (const auto& [geometry, reason] : {std::pair(mesh("empty.stl", "1 1 1"), "empty.stl\": no mesh: "),
                                         {mesh("missing.stl", "1 1 1"), "missing.stl\": "},
                                         {mesh("box.stl", "1 0 1"), "box.stl\": a scale of 0"},
                                         {"<cylinder radius='1' length='0'/>", "a cylinder of length 0"},
                                         {"<sphere radius='0'/>", "a radius of 0"},
                                         {"<box size='1 0 1'/>", "a box with an edge of length 0"}}) {
    with(geometry);
    const SceneDesc scene = read("{file: " + path("bad.urdf") + "}");
    EXPECT_EQ(scene.robot->tree[0].obstacles.size(), 1u) << geometry;
    ASSERT_EQ(scene.robot->left_out.size(), 1u) << geometry;
    EXPECT_EQ(scene.robot->left_out[0].rfind("robot.base_1", 0), 0u) << scene.robot->left_out[0];
    EXPECT_NE(scene.robot->left_out[0].find(reason), std::string::npos) << scene.robot->left_out[0];
    const auto lines = errors_of(sound_scene + "robot: {on_bad_mesh: error, file: " + path("bad.urdf") + "}\n");
    ASSERT_EQ(lines.size(), 1u) << joined(lines);
    EXPECT_EQ(lines[0].rfind("robot.base_1", 0), 0u) << lines[0];
    EXPECT_NE(lines[0].find(reason), std::string::npos) << lines[0];
  }
}

TEST_F(Robot, whatNoObstacleNeedsMayBeWrong) {
  const std::string sphere = "<geometry><sphere radius='1'/></geometry>";
  const auto spheres = [&](const std::string& in_link, const std::string& geometry) {
    write("odd.urdf", "<robot name='r'><material name='m'/><material name='m'/><link name='a'>" + in_link + "<collision>" +
                          sphere + "</collision></link><!-- <visual> --></robot>");
    return all_obstacles(read("{on_bad_mesh: error, file: " + path("odd.urdf") + ", geometry: " + geometry + "}")).size();
  };
  for (const std::string& in_link :
       {std::string("<inertial><mass value='1'/><inertia ixx='x'/></inertial>"), std::string("<inertial/>"),
        "<visual>" + sphere + "<material><color rgba='1 1 1 1'/></material></visual>"}) {
    EXPECT_EQ(spheres(in_link, "collision"), 1u) << in_link;
    EXPECT_EQ(spheres(in_link, "collision_or_visual"), 1u) << in_link;
  }
  EXPECT_EQ(spheres("<visual><geometry><mesh/></geometry></visual>", "collision"), 1u);
  EXPECT_EQ(spheres("<visual>" + sphere + "<material><color/></material></visual><visual>" + sphere + "</visual>", "visual"), 2u);
  EXPECT_THROW(spheres("<visual><geometry><mesh/></geometry></visual>", "visual"), SceneError);
  EXPECT_THROW(spheres("<collision><geometry><mesh/></geometry></collision>", "collision"), SceneError);
}

TEST_F(Robot, openAndMirroredMeshesAreObstacles) {
  Triangles open = box_triangles({1, 1, 1});
  open.triangles.pop_back();
  write("box.stl", stl_of(open));
  write("robot.urdf", replaced(replaced(urdf, "MESH", "file://" + path("box.stl")), "2 3 4", "1 -1 1"));
  const SceneDesc scene = read("{" + file() + "}");
  const ObstacleDesc& arm = scene.robot->tree[1].obstacles.at(0);
  EXPECT_EQ(arm.name, "arm");
  EXPECT_FALSE(arm.mesh->is_closed());
  EXPECT_LT(arm.mesh->closest_point({0, 0, 0}).distance, 0);
}

TEST_F(Robot, visualGeometryMayBeChosen) {
  write("both.urdf",
        "<robot name='r'><link name='base'><visual><geometry><sphere radius='1'/></geometry></visual>"
        "<collision><geometry><box size='1 1 1'/></geometry></collision></link>"
        "<link name='tool'><visual><geometry><sphere radius='2'/></geometry></visual></link>"
        "<joint name='j' type='fixed'><parent link='base'/><child link='tool'/></joint></robot>");
  const auto types = [&](const std::string& geometry) {
    std::vector<ShapeType> found;
    const SceneDesc scene = read("{geometry: " + geometry + ", file: " + path("both.urdf") + "}");
    for (const ObstacleDesc& obstacle : all_obstacles(scene)) found.push_back(obstacle.type);
    return found;
  };
  EXPECT_EQ(types("collision"), (std::vector<ShapeType>{ShapeType::box}));
  EXPECT_EQ(types("visual"), (std::vector<ShapeType>{ShapeType::sphere, ShapeType::sphere}));
  EXPECT_EQ(types("collision_or_visual"), (std::vector<ShapeType>{ShapeType::box, ShapeType::sphere}));
}

TEST_F(Robot, descriptionsMayBeFiles) {
  EXPECT_EQ(read("{description: \"file:" + path("robot.urdf") + "\"}").robot->tree.size(), 4u);
  EXPECT_EQ(read("{description: \"file://" + path("robot.urdf") + "\"}").robot->tree.size(), 4u);
}

TEST_F(Robot, relativeMeshesAreBesideTheFile) {
  write("ws/my_robot/package.xml", "<package><name>my_robot</name></package>");
  write("ws/my_robot/meshes/box.stl", stl_of(box_triangles({1, 1, 1})));
  write("ws/my_robot/urdf/robot.urdf", replaced(urdf, "MESH", "../meshes/box.stl"));
  ASSERT_EQ(setenv("ROS_PACKAGE_PATH", path("ws").c_str(), 1), 0);
  const std::string from_scene = "ws/my_robot/urdf/robot.urdf";
  for (const std::string& file :
       {from_scene, path(from_scene), "file://" + path(from_scene), std::string("package://my_robot/urdf/robot.urdf")}) {
    const std::string text = sound_scene + "robot: {on_bad_mesh: error, file: \"" + file + "\"}\n";
    const SceneDesc scene = read_scene_text(text, {{true, directory_}, {}});
    EXPECT_EQ(scene.robot->tree[1].obstacles[0].mesh->bounds().sizes(), Vector3(2, 3, 4)) << file;
  }
  unsetenv("ROS_PACKAGE_PATH");
}

TEST_F(Robot, scaledMeshesAreThoseOfTheFile) {
  const std::string obstacle = "obstacles: [{name: a, type: mesh, uri: \"file://" + path("box.stl") + "\", scale: 0.5}]\n";
  const SceneDesc scene = read_scene_text(sound_scene + obstacle);
  EXPECT_EQ(scene.obstacles[0].mesh->vertices().size(), 8u);
  EXPECT_EQ(scene.obstacles[0].mesh->bounds().sizes(), Vector3(0.5, 0.5, 0.5));
}

TEST_F(Robot, theNodeReadsMeshesOfPackagesAndOfItsSceneDirectoryOnly) {
  write("ws/group/linked/package.xml", "<package><name> my_robot </name></package>");
  write("ws/group/linked/meshes/box.stl", stl_of(box_triangles({1, 1, 1})));
  ASSERT_EQ(setenv("ROS_PACKAGE_PATH", path("ws").c_str(), 1), 0);
  const auto errors = [&](const std::string& uri, const std::string& scene_directory) {
    const std::string text = sound_scene + "obstacles: [{name: a, type: mesh, uri: \"" + uri + "\"}]\n";
    try {
      read_scene_text(text, {{false, scene_directory}, {}});
    } catch (const SceneError& error) {
      return joined(error.errors());
    }
    return std::string();
  };
  const std::string box = "file://" + path("box.stl");
  EXPECT_EQ(errors("package://my_robot/meshes/box.stl", ""), "");
  EXPECT_NE(errors("package://my_robot/meshes/../../../../box.stl", "").find("it is outside of the package"), std::string::npos);
  EXPECT_NE(errors("package://my_robot", "").find("it is not a file"), std::string::npos);
  EXPECT_NE(errors(box, "").find("it is outside of scene_directory \"\""), std::string::npos);
  EXPECT_EQ(errors(box, directory_), "");
  EXPECT_NE(errors(box, path("ws")).find("it is outside of scene_directory"), std::string::npos);
  EXPECT_NE(errors("file://" + path("ws/../box.stl"), path("ws")).find("it is outside of scene_directory"), std::string::npos);
  std::filesystem::create_symlink(path("box.stl"), path("ws/link.stl"));
  EXPECT_NE(errors("file://" + path("ws/link.stl"), path("ws")).find("it is outside of scene_directory"), std::string::npos);
  unsetenv("ROS_PACKAGE_PATH");
}

}  // namespace
}  // namespace verlet_cable

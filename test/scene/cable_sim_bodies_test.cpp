#include "cable_sim_fixture.h"
#include "scene_text.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {
namespace {

using test::sound_scene;

const std::string scene_with_bodies = sound_scene + R"(
bodies:
  - {name: top, mass: 1, inertia: [1, 2, 2.5], pose: [1, 2, 3, 0.4, 0.5, 0.6], velocity: [1, 0, 0], angular_velocity: [0, 2, 0]}
  - {name: plate, mass: 2, shapes: [{type: box, size: [0.1, 0.2, 0.01]}], pose: [0, 0, -1, 0, 0, 0],
     attachments: [{name: bolt, type: clamp, offset: [0, 0, -1]}]}
)";

std::string rows_of(const World& world) {
  std::string text;
  for (const SimulatedBody& body : world.bodies()) {
    const Quaternion& q = body.pose.orientation;
    text += number_text(world.time()) + "," + body.name;
    for (const double number : body.pose.position) text += "," + number_text(number);
    for (const double number : {q.x(), q.y(), q.z(), q.w()}) text += "," + number_text(number);
    for (const double number : body.velocity) text += "," + number_text(number);
    for (const double number : body.angular_velocity) text += "," + number_text(number);
    text += "\n";
  }
  return text;
}

TEST_F(CableSim, bodiesHaveTheirOwnRows) {
  const std::string scene_path = write("scene.yaml", scene_with_bodies);
  ASSERT_EQ(run(scene_path + " --duration 0.1 --rate 50 --bodies " + path("b.csv") + " --output " + path("o.csv")), 0) << err;
  const SceneDesc scene = read_scene_text(scene_with_bodies);
  const BoundaryInputs frames = initial_frames(scene);
  World world(scene, frames);
  std::string expected = "t,body,x,y,z,qx,qy,qz,qw,vx,vy,vz,wx,wy,wz\n" + rows_of(world);
  for (int step = 1; step <= 50; ++step) {
    world.step(frames);
    if (step % 10 == 0) expected += rows_of(world);
  }
  EXPECT_EQ(content(path("b.csv")), expected);
  // Those of the nodes are as without bodies.
  for (const Row& row : rows("o.csv")) EXPECT_EQ(row.cable, "hose");
}

TEST_F(CableSim, withoutBodiesTheirFileIsAHeader) {
  const std::string scene = write("scene.yaml", sound_scene);
  ASSERT_EQ(run(scene + " --duration 0.1 --bodies " + path("b.csv") + " --summary " + path("s.json")), 0) << err;
  EXPECT_EQ(content(path("b.csv")), "t,body,x,y,z,qx,qy,qz,qw,vx,vy,vz,wx,wy,wz\n");
  EXPECT_TRUE(summary("s.json")["bodies"].IsMap());
  EXPECT_EQ(summary("s.json")["bodies"].size(), 0u);
}

TEST_F(CableSim, theSummaryHasBodiesAndWhatHoldsThem) {
  const std::string scene = write("scene.yaml", scene_with_bodies);
  ASSERT_EQ(run(scene + " --duration 0 --summary " + path("s.json")), 0) << err;
  const YAML::Node json = summary("s.json"), top = json["bodies"]["top"];
  EXPECT_EQ(json["bodies"].size(), 2u);
  const Quaternion turned = quaternion_from_rpy({0.4, 0.5, 0.6});
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(top["position"][axis].as<double>(), axis + 1);
    EXPECT_EQ(top["orientation"][axis].as<double>(), turned.coeffs()[axis]);
  }
  EXPECT_EQ(top["orientation"][3].as<double>(), turned.w());
  EXPECT_EQ(json["attachments"]["bolt"]["force"].size(), 3u);
  EXPECT_EQ(json["segments"].as<int>(), 22);  // two bodies beside the cable's 20
}

}  // namespace
}  // namespace verlet_cable

#include "verlet_cable/scene/loads.h"

#include <gtest/gtest.h>

#include <fstream>

#include "cable_sim_fixture.h"
#include "scene_text.h"

namespace verlet_cable {
namespace {

using test::sound_scene;

const std::string header = "t,name,on,node,fx,fy,fz,tx,ty,tz\n";
const std::string scene_with_body =
    sound_scene + "\nbodies: [{name: plug, mass: 1, inertia: [1, 1, 1], pose: [0, 5, 0, 0, 0, 0]}]\n";

std::vector<std::string> errors_of(const std::string& text, Loads* loads = nullptr) {
  const std::string path = testing::TempDir() + "loads_test.csv";
  std::ofstream(path, std::ios::binary) << text;
  try {
    const Loads read = read_loads_file(path);
    if (loads) *loads = read;
  } catch (const SceneError& error) {
    return error.errors();
  }
  return {};
}

TEST(Loads, areReadInTheOrderOfTheirTimes) {
  Loads loads;
  ASSERT_TRUE(
      errors_of(header + "1,a,hose,3,1,2,3,0,0,0\n 0 , b , plug , -1 , 0,0,0 , 4,5,6\n2,a,hose,4,0,0,0,0,0,0\n", &loads).empty());
  ASSERT_EQ(loads.size(), 3u);
  EXPECT_EQ(loads[0].name, "b");
  EXPECT_EQ(loads[0].on, "plug");
  EXPECT_EQ(loads[0].node, -1);
  EXPECT_EQ(loads[0].torque, Vector3(4, 5, 6));
  EXPECT_EQ(loads[1].time, 1);
  EXPECT_EQ(loads[1].force, Vector3(1, 2, 3));
  EXPECT_EQ(loads[1].line, 2u);
  EXPECT_EQ(loads[2].node, 4);
  EXPECT_TRUE(errors_of(header, &loads).empty());
  EXPECT_TRUE(loads.empty());
}

TEST(Loads, everythingWrongIsToldWithItsLine) {
  const auto expect_error = [](const std::string& row, const std::string& error) {
    const std::vector<std::string> errors = errors_of(header + row + "\n");
    ASSERT_EQ(errors.size(), 1u) << row;
    EXPECT_EQ(errors[0].rfind("line 2: " + error, 0), 0u) << errors[0];
  };
  expect_error("0,a,hose,3,1,2,3", "7 columns; allowed: 10: t,name,on,node,fx,fy,fz,tx,ty,tz");
  expect_error("nan,a,hose,3,1,2,3,0,0,0", "t \"nan\"; allowed: finite numbers [s]");
  expect_error("0,a b,hose,3,1,2,3,0,0,0", "name \"a b\"; allowed: ");
  expect_error("0,a,hose,1.5,1,2,3,0,0,0", "node \"1.5\"; allowed: a node's number from 0 on, or -1 for a body");
  expect_error("0,a,hose,-2,1,2,3,0,0,0", "node \"-2\"");
  expect_error("0,a,hose,3,1,inf,3,0,0,0", "fy \"inf\"; allowed: finite numbers [N]");
  expect_error("0,a,plug,-1,1,0,3,0,0,x", "tz \"x\"; allowed: finite numbers [N m]");
  expect_error("0,a,hose,3,1,2,3,0,0,1", "tx, ty, tz 0, 0, 1 on node 3; allowed: 0, a node takes a force only");
  EXPECT_EQ(errors_of(header + "1,a,hose,3,1,2,3,0,0,0\n1,a,hose,3,0,0,0,0,0,0\n").at(0),
            "line 3: t 1 of \"a\"; allowed: times that ascend, the load's last one is 1");
  EXPECT_EQ(errors_of("t,x\n").at(0), "line 1: header \"t,x\"; allowed: t,name,on,node,fx,fy,fz,tx,ty,tz");
  EXPECT_EQ(errors_of("").at(0), "empty; allowed: the header t,name,on,node,fx,fy,fz,tx,ty,tz and rows");
  EXPECT_EQ(errors_of(header + "x,a,hose,y,z,0,0,0,0,0\n").size(), 3u);
}

TEST(Loads, mustFitTheScene) {
  const SceneDesc scene = read_scene_text(scene_with_body);
  Loads loads;
  ASSERT_TRUE(errors_of(header +
                            "3,a,hose,99,1,0,0,0,0,0\n1,b,rope,0,1,0,0,0,0,0\n2,c,hose,-1,1,0,0,0,0,0\n2,d,plug,0,1,0,0,0,0,0\n"
                            "2,e,plug,-1,1,0,0,0,0,0\n",
                        &loads)
                  .empty());
  const std::vector<std::string> errors = validate_loads(loads, scene);
  ASSERT_EQ(errors.size(), 4u);
  EXPECT_EQ(errors[0], "line 2: node 99 of cable \"hose\"; allowed: 0 to 20");
  EXPECT_EQ(errors[1], "line 3: on \"rope\"; allowed: hose, plug");
  EXPECT_EQ(errors[2], "line 4: node -1 of cable \"hose\"; allowed: a node from 0 on");
  EXPECT_EQ(errors[3], "line 5: node 0 of body \"plug\"; allowed: -1");
}

TEST_F(CableSim, loadsActFromTheirTimesOn) {
  const std::string scene = write("scene.yaml", scene_with_body);
  write("l.csv", header + "0,lift,plug,-1,0,0,9.81,0,0,0\n0.05,push,plug,-1,2,0,0,0,0,0\n0.1,push,plug,-1,0,0,0,0,0,0\n");
  ASSERT_EQ(
      run(scene + " --duration 0.2 --loads " + path("l.csv") + " --bodies " + path("b.csv") + " --summary " + path("s.json")), 0)
      << err;
  const YAML::Node json = summary("s.json");
  // 2 N for 0.05 s, then 0.1 m/s for 0.1 s.
  EXPECT_NEAR(json["bodies"]["plug"]["position"][0].as<double>(), 0.5 * 2 * 0.05 * 0.05 + 0.1 * 0.1, 1e-9);
  EXPECT_NEAR(json["bodies"]["plug"]["position"][2].as<double>(), 0, 1e-9);
  EXPECT_NEAR(json["ledger"]["work"]["applied"].as<double>(), 0.5 * 0.1 * 0.1, 1e-9);
}

TEST_F(CableSim, refusesLoadsThatItCannotUse) {
  const std::string scene = write("scene.yaml", scene_with_body);
  write("l.csv", header + "0,a,hose,x,1,0,0,0,0,0\n0,b,hose,1,1,0,0,1,0,0\n");
  EXPECT_EQ(run(scene + " --loads " + path("l.csv")), 2);
  EXPECT_NE(err.find("l.csv: line 2: node \"x\""), std::string::npos) << err;
  EXPECT_NE(err.find("l.csv: line 3: tx, ty, tz 1, 0, 0"), std::string::npos) << err;
  write("l.csv", header + "0,a,hose,21,1,0,0,0,0,0\n");
  EXPECT_EQ(run(scene + " --loads " + path("l.csv") + " --output " + path("o.csv")), 2);
  EXPECT_NE(err.find("line 2: node 21 of cable \"hose\"; allowed: 0 to 20"), std::string::npos) << err;
  EXPECT_FALSE(exists("o.csv"));
  EXPECT_EQ(run(scene + " --loads " + path("none.csv")), 2);
  EXPECT_EQ(run(scene + " --loads " + path("l.csv") + " --output " + path("l.csv")), 2);
  EXPECT_NE(err.find("is the loads"), std::string::npos) << err;
}

}  // namespace
}  // namespace verlet_cable

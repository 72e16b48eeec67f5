#include <algorithm>
#include <cmath>
#include <map>

#include "cable_sim_fixture.h"
#include "scene_text.h"

namespace verlet_cable {
namespace {

using test::replaced;

constexpr double gravity = 9.81;

/// A clamped cable of 0.1 kg/m and 0.01 N m^2 that starts straight out.
constexpr const char* cantilever = R"(
materials: {m: {linear_density: 0.1, radius: 0.005, bending_stiffness: 0.01}}
cables:
  - {name: c, length: 1, segments: 50, material: m, initial: {type: straight, to: [1, 0, 0]}, attachments: [{name: wall, at: start, type: clamp}]}
)";

TEST_F(CableSim, settledCablesStandStillFromTheStart) {
  const std::string scene = write("scene.yaml", cantilever);
  ASSERT_EQ(run(scene + " --settle --duration 1 --output " + path("o.csv") + " --summary " + path("s.json")), 0) << err;
  const std::vector<Row> read = rows("o.csv");
  ASSERT_EQ(read.size(), 101u * 51u);
  EXPECT_LT(read[50].position.z(), -0.5);
  for (std::size_t i = 0; i < read.size(); ++i) {
    // Newton ends within 1e-5 of a segment's length; what is left swings.
    EXPECT_NEAR((read[i].position - read[i % 51].position).norm(), 0, 1e-6) << read[i].time << " " << read[i].node;
  }
  const YAML::Node json = summary("s.json");
  EXPECT_NEAR(json["attachments"]["wall"]["force"].as<std::vector<double>>()[2], -0.1 * gravity, 1e-5);
  EXPECT_LT(json["energy"]["kinetic"].as<double>(), 1e-10);
  // Taken after settling: nothing has been lost since.
  EXPECT_NEAR(json["energy"]["initial_total"].as<double>(), json["energy"]["total"].as<double>(), 1e-8);
  EXPECT_GT(json["energy"]["bend"].as<double>(), 0.01);
  EXPECT_EQ(json["events"].size(), 0u);
}

TEST_F(CableSim, extremesAreOfEachCableWithTimeAndPlace) {
  const std::string scene = write("scene.yaml", cantilever);
  ASSERT_EQ(run(scene + " --settle --duration 0.1 --output " + path("o.csv") + " --summary " + path("s.json")), 0) << err;
  const YAML::Node json = summary("s.json"), extremes = json["extremes"]["c"];
  // The tightest bend is at the clamp, half a segment from its joint's other side: EI / moment.
  const std::vector<double> torque = json["attachments"]["wall"]["torque"].as<std::vector<double>>();
  EXPECT_NEAR(extremes["min_bend_radius"]["value"].as<double>() * std::abs(torque[1]) / 0.01, 1, 1e-4);
  EXPECT_EQ(extremes["min_bend_radius"]["arc_length"].as<double>(), 0);
  double largest = -1e9, smallest = 1e9;
  for (const Row& row : rows("o.csv")) {
    largest = std::max(largest, row.tension);
    smallest = std::min(smallest, row.tension);
  }
  EXPECT_NEAR(extremes["max_tension"]["value"].as<double>(), largest, 1e-5);
  EXPECT_NEAR(extremes["min_tension"]["value"].as<double>(), smallest, 1e-5);
  const double place = extremes["max_tension"]["arc_length"].as<double>() / 0.02 - 0.5;
  EXPECT_NEAR(place, std::round(place), 1e-9) << "the middle of a segment";
  EXPECT_TRUE(extremes["max_twist"]["value"].IsNull());
}

TEST_F(CableSim, extremesOfTwistAreThoseOfTheMaterial) {
  const std::string scene = write("scene.yaml", R"(
gravity: [0, 0, 0]
materials: {m: {linear_density: 0.1, radius: 0.005, bending_stiffness: [0.01, 0.001], torsional_stiffness: 0.002}}
cables:
  - {name: c, length: 1, segments: 20, material: m, rest_twist: -1.5, initial: {type: straight, to: [1, 0, 0]},
     attachments: [{name: wall, at: start, type: clamp}]}
)");
  ASSERT_EQ(run(scene + " --duration 0.1 --summary " + path("s.json")), 0) << err;
  const YAML::Node json = summary("s.json"), extremes = json["extremes"]["c"];
  EXPECT_NEAR(extremes["max_twist"]["value"].as<double>(), -1.5, 1e-9);
  EXPECT_TRUE(extremes["min_bend_radius"]["value"].IsNull());
  EXPECT_NEAR(json["energy"]["twist"].as<double>(), 0, 1e-12);
  EXPECT_NEAR(json["energy"]["bend"].as<double>(), 0, 1e-12);
}

TEST_F(CableSim, aSceneMaySettleByItself) {
  const std::string text = replaced(cantilever, "{type: straight, to: [1, 0, 0]}", "{type: settled}");
  ASSERT_EQ(run(write("settled.yaml", text) + " --duration 0 --output " + path("a.csv")), 0) << err;
  ASSERT_EQ(run(write("straight.yaml", cantilever) + " --settle --duration 0 --output " + path("b.csv")), 0) << err;
  const std::vector<Row> a = rows("a.csv"), b = rows("b.csv");
  ASSERT_EQ(a.size(), b.size());
  // They come from different sides to the same equilibrium.
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR((a[i].position - b[i].position).norm(), 0, 1e-6);
}

TEST_F(CableSim, aCableThatStartsInsideAnObstacleIsReportedOnce) {
  const std::string scene = write("scene.yaml", R"(
materials: {rope: {linear_density: 0.1, radius: 0.005}}
cables:
  - {name: r, length: 0.3, segments: 30, material: rope, initial: {type: straight, from: [-0.15, 0, 0.03], to: [0.15, 0, 0.03]}}
obstacles: [{name: block, type: box, size: [0.4, 0.4, 0.1]}]
)");
  ASSERT_EQ(run(scene + " --duration 1 --summary " + path("s.json")), 0) << err;
  const YAML::Node events = summary("s.json")["events"];
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(events[0]["type"].as<std::string>(), "inside_obstacle");
  EXPECT_EQ(events[0]["cable"].as<std::string>(), "r");
  EXPECT_EQ(events[1]["type"].as<std::string>(), "inside_obstacle_end");
  EXPECT_NE(err.find("inside block"), std::string::npos) << err;
}

TEST_F(CableSim, aCableWithoutEquilibriumIsReported) {
  // Its weight would stretch it to five hundred times its length, further than settling goes.
  const std::string scene = write("scene.yaml", R"(
materials: {gum: {linear_density: 0.1, radius: 0.005, axial_stiffness: 0.001}, rope: {linear_density: 0.1, radius: 0.005}}
cables:
  - {name: g, length: 1, segments: 20, material: gum, initial: {type: settled}, attachments: [{name: a, at: start}]}
  - {name: r, length: 1, segments: 20, material: rope, initial: {type: settled}, attachments: [{name: b, at: start}]}
)");
  for (const std::string option : {"", " --settle"}) {
    ASSERT_EQ(run(scene + option + " --duration 0 --summary " + path("s.json")), 0) << err;
    const YAML::Node events = summary("s.json")["events"];
    ASSERT_EQ(events.size(), 1u) << err;
    EXPECT_EQ(events[0]["type"].Scalar(), "not_settled");
    EXPECT_EQ(events[0]["cable"].Scalar(), "g");
    EXPECT_NE(err.find("not_settled: g"), std::string::npos) << err;
  }
}

TEST_F(CableSim, aBrokenCableIsTwoCables) {
  // Pulled at 0.05 m/s: it is strained by 15 N / 1 kN when the hand has moved by 15 mm.
  const std::string scene = write("scene.yaml", R"(
materials: {m: {linear_density: 0.1, radius: 0.005, axial_stiffness: 1e3, axial_damping: 10, breaking_tension: 15}}
cables:
  - {name: c, length: 1, segments: 20, material: m, attachments: [{name: a, at: start}, {name: b, at: end, frame: hand}]}
)");
  const std::string motion = write("m.csv", "t,frame,x,y,z,qx,qy,qz,qw\n0,hand,1,0,0,0,0,0,1\n1,hand,1.05,0,0,0,0,0,1\n");
  ASSERT_EQ(
      run(scene + " --settle --duration 1 --motion " + motion + " --output " + path("o.csv") + " --summary " + path("s.json")), 0)
      << err;
  const YAML::Node events = summary("s.json")["events"];
  ASSERT_EQ(events.size(), 1u) << err;
  EXPECT_EQ(events[0]["type"].Scalar(), "BROKE");
  EXPECT_EQ(events[0]["cable"].Scalar(), "c");
  EXPECT_EQ(events[0]["other"].Scalar(), "c_2");
  const double time = events[0]["time"].as<double>();
  const int segment = events[0]["node"].as<int>();
  // Sag and damping take a part of the strain and of the tension.
  EXPECT_NEAR(time, 0.3, 0.03);
  std::map<std::string, int> rows_of;
  for (const Row& row : rows("o.csv")) {
    ++rows_of[(row.time < time ? "whole " : "broken ") + row.cable];
  }
  const int before = static_cast<int>(std::ceil(time * 100 - 1e-6)), after = 101 - before;
  EXPECT_EQ(rows_of["whole c"], before * 21);
  EXPECT_EQ(rows_of["whole c_2"], 0);
  EXPECT_EQ(rows_of["broken c"], after * (segment + 1));
  EXPECT_EQ(rows_of["broken c_2"], after * (20 - segment));
  EXPECT_NE(err.find("BROKE: c node " + std::to_string(segment)), std::string::npos) << err;
}

}  // namespace
}  // namespace verlet_cable

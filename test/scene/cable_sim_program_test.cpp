#include <fcntl.h>

#include <algorithm>
#include <map>

#include "cable_sim_fixture.h"
#include "scene_text.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {
namespace {

using test::replaced;
using test::sound_scene;

constexpr double gravity = 9.81;

constexpr const char* tetrahedron = "v 9 0 0\nv 9 1 0\nv 9 0 1\nv 10 0 0\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

TEST_F(CableSim, rowsAreTheWorldsOwnNumbers) {
  const std::string scene_path = write("scene.yaml", sound_scene);
  ASSERT_EQ(run(scene_path + " --duration 0.5 --rate 50 --output " + path("o.csv")), 0) << err;
  const std::vector<Row> read = rows("o.csv");
  ASSERT_EQ(read.size(), 26u * 21u);

  const SceneDesc scene = read_scene_text(sound_scene);
  const BoundaryInputs frames = initial_frames(scene);
  World world(scene, frames);
  std::size_t at = 0;
  for (int step = 0; step <= 250; ++step) {
    if (step > 0) world.step(frames);
    if (step % 10 != 0) continue;
    const SimulatedCable& cable = world.cables()[0];
    for (int node = 0; node < cable.state.nodes(); ++node, ++at) {
      const auto i = static_cast<std::size_t>(node);
      ASSERT_EQ(read[at].time, world.time());
      ASSERT_EQ(read[at].cable, "hose");
      ASSERT_EQ(read[at].node, node);
      ASSERT_EQ(read[at].position, cable.state.positions[i]);
      ASSERT_EQ(read[at].velocity, cable.state.velocities[i]);
      ASSERT_EQ(read[at].tension, cable.state.tension[std::min<std::size_t>(i, 19)]);
    }
  }
}

TEST_F(CableSim, aFreeCableFalls) {
  write("scene.yaml", replaced(sound_scene, sound_scene.substr(sound_scene.find("    attachments")), ""));
  ASSERT_EQ(run(path("scene.yaml") + " --duration 1 --rate 10 --output " + path("o.csv")), 0) << err;
  const std::vector<Row> read = rows("o.csv");
  ASSERT_EQ(read.size(), 11u * 21u);
  for (const Row& row : read) {
    // Constant acceleration is integrated exactly but for rounding over 500 steps.
    EXPECT_NEAR(row.position.z(), -gravity * row.time * row.time / 2, 1e-10) << row.time;
    EXPECT_NEAR(row.velocity.z(), -gravity * row.time, 1e-10) << row.time;
  }
}

TEST_F(CableSim, theSameInputGivesTheSameBytes) {
  const std::string scene = write("scene.yaml", sound_scene);
  for (const char* tag : {"a", "b"})
    ASSERT_EQ(run(scene + " --duration 1 --output " + path(tag + std::string(".csv")) + " --summary " +
                  path(tag + std::string(".json"))),
              0);
  EXPECT_EQ(content(path("a.csv")), content(path("b.csv")));
  EXPECT_EQ(summary("a.json")["state_hash"].Scalar(), summary("b.json")["state_hash"].Scalar());
}

TEST_F(CableSim, rowsThatFallBetweenStepsAreTheNextStep) {
  const std::string scene = write("scene.yaml", replaced(sound_scene, "time_step: 0.002", "time_step: 0.003"));
  ASSERT_EQ(run(scene + " --duration 0.05 --output " + path("o.csv")), 0) << err;
  std::vector<double> times;
  for (const Row& row : rows("o.csv")) {
    if (row.node == 0) times.push_back(row.time);
  }
  const double expected[] = {0, 0.012, 0.021, 0.030, 0.042, 0.051};
  ASSERT_EQ(times.size(), std::size(expected));
  for (std::size_t i = 0; i < times.size(); ++i) EXPECT_NEAR(times[i], expected[i], 1e-12);
}

TEST_F(CableSim, stepsThatAreLongerThanARowAreTheRows) {
  const std::string scene = write("scene.yaml", replaced(sound_scene, "time_step: 0.002", "time_step: 0.02"));
  ASSERT_EQ(run(scene + " --duration 0.1 --output " + path("o.csv")), 0) << err;
  const std::vector<Row> all = rows("o.csv");
  ASSERT_EQ(all.size(), 6u * 21);
  EXPECT_EQ(all.back().time, 0.1);
}

TEST_F(CableSim, summaryOfACableAtRest) {
  // 0.1 kg of cable, held at one end, starts at rest straight down.
  write("scene.yaml", R"(
materials: {m: {linear_density: 0.1, radius: 0.005}}
cables:
  - {name: c, length: 1, segments: 20, material: m, attachments: [{name: hook, at: start, offset: [0, 0, 2]}], point_masses: [{at: end, mass: 0.4}]}
)");
  ASSERT_EQ(run(path("scene.yaml") + " --duration 2 --summary " + path("s.json")), 0) << err;
  const YAML::Node json = summary("s.json");
  EXPECT_EQ(json["sim_time"].as<double>(), 2);
  EXPECT_EQ(json["steps"].as<int>(), 2000);
  EXPECT_EQ(json["segments"].as<int>(), 20);
  EXPECT_GE(json["substeps"].as<int>(), 2000);
  EXPECT_GT(json["wall_time"].as<double>(), 0);
  // The quotient of two numbers of the summary.
  EXPECT_NEAR(json["real_time_factor"].as<double>() * json["wall_time"].as<double>(), 2, 1e-9);
  EXPECT_NEAR(json["ns_per_segment_substep"].as<double>() * 20 * json["substeps"].as<double>(),
              1e9 * json["wall_time"].as<double>(), 1);
  // Lengths are solved to a relative 1e-6 or better.
  EXPECT_LT(json["max_strain"].as<double>(), 1e-6);
  const double weight = 0.5 * gravity;
  for (const char* key : {"force", "force_now"}) {
    const auto force = json["attachments"]["hook"][key].as<std::vector<double>>();
    EXPECT_NEAR(force[0], 0, 1e-9);
    EXPECT_NEAR(force[2], -weight, 1e-5 * weight) << key;  // as exact as the lengths
  }
  const double potential = gravity * (0.1 * 1.5 + 0.4 * 1.0);
  EXPECT_NEAR(json["energy"]["gravity"].as<double>(), potential, 1e-6);
  EXPECT_NEAR(json["energy"]["initial_total"].as<double>(), potential, 1e-6);
  EXPECT_EQ(json["events"].size(), 0u);
  EXPECT_EQ(json["state_hash"].Scalar().size(), 16u);
}

TEST_F(CableSim, atMostTenFramesThatAreNotUsedAreNamed) {
  const std::string scene = write("scene.yaml", sound_scene);
  std::string motion = "t,frame,x,y,z,qx,qy,qz,qw\n";
  for (int i = 10; i < 30; ++i) motion += "0,f" + std::to_string(i) + ",0,0,0,0,0,0,1\n";
  ASSERT_EQ(run(scene + " --duration 0 --motion " + write("m.csv", motion)), 0) << err;
  EXPECT_NE(err.find("the scene does not use frames \"f10\", \"f11\""), std::string::npos) << err;
  EXPECT_NE(err.find("\"f19\" and 10 more\n"), std::string::npos) << err;
}

TEST_F(CableSim, framesThatHoldSomethingNeedAPose) {
  const std::string unplaced = replaced(sound_scene, ", initial_pose: [0.7, 0, 0, 0, 0, 0]", "") +
                               "guides: [{name: eye, cable: hose, at: 0.5, frame: mast, type: eyelet}]\n";
  const std::string scene = write("scene.yaml", unplaced);
  const std::string header = "t,frame,x,y,z,qx,qy,qz,qw\n";
  const auto told = [&](const std::string& frame) {
    return "cable_sim: " + scene + ": frame \"" + frame +
           "\": it has no pose; allowed: initial_pose: [x, y, z, roll, pitch, yaw] (m, rad) beside frame: " + frame +
           " in the scene, or rows of it in --motion MOTION.csv";
  };
  for (const char* option : {"", " --settle"}) {
    EXPECT_EQ(run(scene + option + " --duration 0 --output " + path("o.csv")), 2);
    EXPECT_EQ(err, told("hand") + "\n" + told("mast") + "\ncable_sim: 2 errors, nothing was simulated\n");
    EXPECT_FALSE(exists("o.csv"));
  }
  const std::string misspelled = write("m.csv", header + "0,hamd,0.7,0,0,0,0,0,1\n0,mast,0.3,0,0,0,0,0,1\n");
  EXPECT_EQ(run(scene + " --duration 0 --motion " + misspelled), 2);
  EXPECT_EQ(err, told("hand") + " (did you mean \"hamd\", which the scene does not use?)\n" +
                     "cable_sim: 1 error, nothing was simulated\n");

  const std::string motion = write("m.csv", header + "0,hand,0.7,0,0,0,0,0,1\n0,mast,0.3,0,0,0,0,0,1\n");
  EXPECT_EQ(run(scene + " --duration 0 --motion " + motion), 0) << err;
  EXPECT_EQ(err, "");
}

TEST_F(CableSim, framesOfObstaclesThatNothingPlacesAreAtTheOrigin) {
  const std::string scene =
      write("scene.yaml",
            sound_scene + "obstacles: [{name: box, type: box, frame: cart, pose: [0, 0, 9, 0, 0, 0], size: [1, 1, 1]}]\n");
  EXPECT_EQ(run(scene + " --duration 0"), 0);
  EXPECT_EQ(err.find("cable_sim: warning: there is no pose of frame \"cart\": it stays at the origin; give one by --motion "
                     "MOTION.csv or as initial_pose in the scene\n"),
            0u)
      << err;
}

TEST_F(CableSim, motionIsFollowedAndHeld) {
  const std::string scene = write("scene.yaml", sound_scene);
  const std::string motion = write(
      "m.csv", "t,frame,x,y,z,qx,qy,qz,qw\n0,hand,0.7,0,0,0,0,0,1\n0.5,hand,0.8,0,0.1,0,0,0,1\n0,elsewhere,0,0,0,0,0,0,1\n");
  ASSERT_EQ(run(scene + " --duration 1 --rate 100 --motion " + motion + " --output " + path("o.csv")), 0) << err;
  EXPECT_NE(err.find("the scene does not use frame \"elsewhere\""), std::string::npos) << err;
  for (const Row& row : rows("o.csv")) {
    if (row.node != 20) continue;
    const double u = std::min(1.0, row.time / 0.5);
    EXPECT_NEAR((row.position - Vector3(0.7 + 0.1 * u, 0, 0.1 * u)).norm(), 0, 1e-12) << row.time;
  }
}

TEST_F(CableSim, overstretchingIsReportedOnceWithBeginAndEnd) {
  const std::string scene = write("scene.yaml", sound_scene);
  const std::string motion = write("m.csv",
                                   "t,frame,x,y,z,qx,qy,qz,qw\n0,hand,0.7,0,0,0,0,0,1\n0.5,hand,1.1,0,0,0,0,0,1\n"
                                   "1,hand,1.1,0,0,0,0,0,1\n1.5,hand,0.7,0,0,0,0,0,1\n");
  ASSERT_EQ(run(scene + " --duration 2 --motion " + motion + " --summary " + path("s.json")), 0) << err;
  std::map<std::string, int> types;
  for (const auto& event : summary("s.json")["events"]) ++types[event["type"].Scalar()];
  EXPECT_EQ(types["overstretched"], 1);
  EXPECT_EQ(types["overstretched_end"], 1);
  EXPECT_NE(err.find("overstretched: hose"), std::string::npos) << err;
  EXPECT_GT(summary("s.json")["max_strain"].as<double>(), 0.05);
}

TEST_F(CableSim, aFrameThatIsTooFastIsFollowedAtTheAllowedSpeed) {
  const std::string scene =
      write("scene.yaml", replaced(sound_scene, "time_step: 0.002", "time_step: 0.002\nmax_frame_speed: 0.1"));
  const std::string motion = write("m.csv", "t,frame,x,y,z,qx,qy,qz,qw\n0,hand,0.7,0,0,0,0,0,1\n0.05,hand,0.8,0,0,0,0,0,1\n");
  ASSERT_EQ(run(scene + " --duration 2 --motion " + motion + " --output " + path("o.csv") + " --summary " + path("s.json")), 0)
      << err;
  for (const Row& row : rows("o.csv")) {
    if (row.node != 20) continue;
    EXPECT_NEAR(row.position.x(), std::min(0.8, 0.7 + 0.1 * row.time), 1e-9) << row.time;
  }
  const YAML::Node events = summary("s.json")["events"];
  ASSERT_GE(events.size(), 1u);
  EXPECT_EQ(events[0]["type"].Scalar(), "frame_too_fast");
  EXPECT_EQ(events[0]["frame"].Scalar(), "hand");
}

TEST_F(CableSim, aFrameThatASplineTakesTooFarAwayIsReported) {
  const std::string scene =
      write("scene.yaml", std::string(sound_scene) +
                              "obstacles: [{name: ball, type: sphere, radius: 0.1, pose: [0, 0, -5, 0, 0, 0], frame: far}]\n");
  // On its way back it overshoots what rows may say.
  const std::string motion = write("m.csv",
                                   "t,frame,x,y,z,qx,qy,qz,qw\n0,far,9e8,0,0,0,0,0,1\n0.5,far,1e9,0,0,0,0,0,1\n"
                                   "1,far,9.9e8,0,0,0,0,0,1\n");
  ASSERT_EQ(run(scene + " --duration 2 --motion " + motion + " --summary " + path("s.json")), 0) << err;
  std::map<std::string, std::string> frames;
  for (const auto& event : summary("s.json")["events"]) frames[event["type"].Scalar()] = event["frame"].Scalar();
  EXPECT_EQ(frames["frame_out_of_range"], "far");
  EXPECT_EQ(frames["frame_out_of_range_end"], "far");
}

TEST_F(CableSim, theStartObeysTheAllowedSpeed) {
  const std::string scene =
      write("scene.yaml", replaced(sound_scene, "time_step: 0.002", "time_step: 0.002\nmax_frame_speed: 0.1"));
  const std::string motion = write("m.csv", "t,frame,x,y,z,qx,qy,qz,qw\n0,hand,0.7,0,0,0,0,0,1\n1,hand,0.2,0,0,0,0,0,1\n");
  ASSERT_EQ(run(scene + " --duration 0.02 --rate 500 --motion " + motion + " --output " + path("o.csv")), 0) << err;
  for (const Row& row : rows("o.csv")) {
    if (row.node != 20) continue;
    EXPECT_NEAR(row.velocity.x(), -0.1, 1e-9) << row.time;
  }
}

TEST_F(CableSim, aJumpIsToldInTheFirstStepAndInTheLast) {
  const std::string scene = write("scene.yaml", sound_scene);
  const std::string header = "t,frame,x,y,z,qx,qy,qz,qw\n0,hand,0.7,0,0,0,0,0,1\n";
  for (const char* jump :
       {"0.002,hand,0.6,0,0,0,0,0,1\n1,hand,0.6,0,0,0,0,0,1\n", "0.098,hand,0.7,0,0,0,0,0,1\n0.1,hand,0.6,0,0,0,0,0,1\n"}) {
    const std::string motion = write("m.csv", header + jump);
    ASSERT_EQ(run(scene + " --duration 0.1 --motion " + motion + " --summary " + path("s.json")), 0) << err;
    const YAML::Node events = summary("s.json")["events"];
    ASSERT_EQ(events.size(), 1u) << jump;
    EXPECT_EQ(events[0]["type"].Scalar(), "JUMPED");
    EXPECT_NE(events[0]["message"].Scalar().find("jumped by 0.1 m within 2 ms: "), std::string::npos);
  }
}

TEST_F(CableSim, everyErrorOfSceneMotionAndOptionsIsListedAndNothingIsWritten) {
  const std::string scene =
      write("scene.yaml", replaced(replaced(sound_scene, "gravity", "gravty"), "material: m", "material: none_such"));
  const std::string motion = write("m.csv", "t,frame,x,y,z,qx,qy,qz,qw\n0,hand,0.7,0,0,0,0,0,0\n");
  write("old.json", "old");
  EXPECT_EQ(run(scene + " --duration -3 --durashun 3 --motion " + motion + " --output " + path("o.csv") + " --summary " +
                path("old.json")),
            2);
  for (const char* what : {"gravty: unknown key", "none_such", "m.csv: line 2: quaternion of length 0", "--duration: \"-3\"",
                           "--durashun: no such option"})
    EXPECT_NE(err.find(what), std::string::npos) << what << "\n" << err;
  EXPECT_FALSE(exists("o.csv"));
  EXPECT_EQ(content(path("old.json")), "old");
}

TEST_F(CableSim, badInputExitsWithTwo) {
  const std::string scene = write("scene.yaml", sound_scene);
  const struct {
    std::string arguments;
    std::string error;
  } cases[] = {
      {"", "no scene"},
      {path("none.yaml"), "No such file or directory"},
      {write("text.yaml", "a: [1, 2"), "line 1, column"},
      {scene + " --rate 501", "--rate: 501; allowed: at most 1 / time_step = 500"},
      {scene + " --rate 0", "--rate: \"0\""},
      {scene + " --duration inf", "--duration: \"inf\""},
      {scene + " --duration 1e-3s", "--duration: \"1e-3s\""},
      {scene + " --output " + path("no/o.csv"), "--output: cannot write"},
      {scene + " --output " + scene, "is the scene; allowed: another file"},
      {scene + " --output " + path("x") + " --summary " + path("x"), "is the output; allowed: another file"},
      {scene + " --output " + path("x") + " --bodies " + path("x"),
       "--bodies: \"" + path("x") + "\" is the output; allowed: another file"},
      {scene + " --bodies " + path("x") + " --summary " + path("x"), "is the output of bodies; allowed: another file"},
      {scene + " --bodies " + scene, "is the scene; allowed: another file"},
      {write("mesh.yaml", std::string(sound_scene) + "obstacles: [{name: part, type: mesh, uri: part.obj}]\n") + " --output " +
           write("part.obj", tetrahedron),
       "--output: \"" + path("part.obj") + "\" is a file of the scene; allowed: another file"},
      {scene + " --motion " + path("none.csv"), "none.csv: cannot read"},
      {scene + " --motion " + write("world.csv", "t,frame,x,y,z,qx,qy,qz,qw\n0,world,0,0,0,0,0,0,1\n"),
       "any but the fixed frame"},
      {scene + " --motion " + write("far.csv", "t,frame,x,y,z,qx,qy,qz,qw\n0,hand,3,0,0,0,0,0,1\n"),
       "far.csv at t = 0: cables[0].length: 1 m of cable between \"left\" and \"right\""},
      {write("far.yaml", replaced(sound_scene, "initial_pose: [0.7, 0, 0, 0, 0, 0]", "initial_pose: [3, 0, 0, 0, 0, 0]")),
       "far.yaml: cables[0].length: 1 m of cable between \"left\" and \"right\""},
  };
  for (const auto& bad : cases) {
    EXPECT_EQ(run(bad.arguments), 2) << bad.arguments;
    EXPECT_NE(err.find(bad.error), std::string::npos) << bad.arguments << "\n" << err;
    EXPECT_EQ(out, "") << bad.arguments;
    EXPECT_FALSE(exists("x"));
  }
  EXPECT_EQ(content(scene), sound_scene);
}

TEST_F(CableSim, noDurationIsTheInitialState) {
  ASSERT_EQ(run(write("scene.yaml", sound_scene) + " --duration 0 --output " + path("o.csv") + " --summary " + path("s.json")), 0)
      << err;
  EXPECT_EQ(rows("o.csv").size(), 21u);
  EXPECT_TRUE(summary("s.json")["real_time_factor"].IsNull());
  EXPECT_EQ(content(path("s.json")).find("nan"), std::string::npos);
}

TEST_F(CableSim, helpIsNoError) {
  EXPECT_EQ(run("--help"), 0);
  EXPECT_EQ(out.rfind("usage: cable_sim SCENE.yaml", 0), 0u);
}

/// What the program prints to a terminal.
std::string output_on_terminal(const std::string& scene, const std::string& duration, const std::string& summary) {
  const int terminal = posix_openpt(O_RDWR | O_NOCTTY);
  if (terminal < 0 || grantpt(terminal) != 0 || unlockpt(terminal) != 0) return {};
  const std::string name = ptsname(terminal);
  const pid_t child = fork();
  if (child == 0) {
    const int side = open(name.c_str(), O_RDWR | O_NOCTTY);
    dup2(side, STDOUT_FILENO);
    dup2(side, STDERR_FILENO);
    execl(CABLE_SIM_PROGRAM, "cable_sim", scene.c_str(), "--duration", duration.c_str(), "--summary", summary.c_str(),
          static_cast<char*>(nullptr));
    _exit(127);
  }
  std::string text;
  std::array<char, 4096> buffer;
  // Reading fails when the program has closed its side; its side may not be open yet at first.
  int status = 0;
  bool done = false;
  while (!done) {
    done = waitpid(child, &status, WNOHANG) == child;
    fcntl(terminal, F_SETFL, O_NONBLOCK);
    for (ssize_t size = read(terminal, buffer.data(), buffer.size()); size > 0;
         size = read(terminal, buffer.data(), buffer.size()))
      text.append(buffer.data(), static_cast<std::size_t>(size));
    usleep(1000);
  }
  close(terminal);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  return text;
}

TEST_F(CableSim, progressIsShownOnATerminalOnly) {
  const std::string scene = write("scene.yaml", replaced(sound_scene, "time_step: 0.002", "time_step: 0.0001"));
  // 200,000 steps take longer than the 0.1 s between two looks at the bar.
  const std::string text = output_on_terminal(scene, "20", "/dev/null");
  EXPECT_NE(text.find("\r["), std::string::npos) << text;
  EXPECT_NE(text.find("times real time"), std::string::npos) << text;
  // Data on the terminal is not overwritten.
  EXPECT_EQ(output_on_terminal(scene, "20", "/dev/stdout").find("\r["), std::string::npos);
  ASSERT_EQ(run(scene + " --duration 20"), 0);
  EXPECT_EQ((out + err).find('\r'), std::string::npos);
}

}  // namespace
}  // namespace verlet_cable

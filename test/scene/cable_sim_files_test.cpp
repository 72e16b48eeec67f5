#include <sys/stat.h>

#include "cable_sim_fixture.h"
#include "scene_text.h"
#include "verlet_cable/core/number_text.h"

namespace verlet_cable {
namespace {

using test::replaced;
using test::sound_scene;

/// A shell's limit on the size of files, in blocks of 512 bytes: a disk that is full, for who is not root.
constexpr const char* small_disk = "ulimit -f 100; ";

TEST_F(CableSim, aFullDeviceExitsWithThree) {
  EXPECT_EQ(run(write("scene.yaml", sound_scene) + " --duration 1e6 --output /dev/full"), 3);
  EXPECT_NE(err.find("stopped at 0 s: cannot write \"/dev/full\": No space left on device"), std::string::npos) << err;
  EXPECT_EQ(run(path("scene.yaml") + " --duration 0.1 --summary /dev/full"), 3);
  EXPECT_NE(err.find("stopped at 0.1 s: cannot write \"/dev/full\": No space left on device"), std::string::npos) << err;
}

/// Rows of the scene's 21 nodes, for all times until the last.
void expect_whole_times(const std::vector<Row>& rows) {
  ASSERT_FALSE(rows.empty());
  ASSERT_EQ(rows.size() % 21, 0u);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ASSERT_EQ(rows[i].node, static_cast<int>(i % 21));
    ASSERT_EQ(rows[i].time, rows[i - i % 21].time);
  }
}

TEST_F(CableSim, aFullDiskStopsTheRunAndKeepsWhatWasDone) {
  const std::string scene = write("scene.yaml", sound_scene);
  write("o.csv", "old");
  const std::string arguments = scene + " --duration 1e6 --output " + path("o.csv") + " --summary " + path("s.json");
  EXPECT_EQ(run(arguments, small_disk), 3);
  const std::vector<Row> kept = rows("o.csv");
  expect_whole_times(kept);
  EXPECT_GT(content(path("o.csv")).size(), 45000u);
  EXPECT_EQ(content(path("o.csv")).back(), '\n');
  std::ostringstream until;
  until << "cannot write \"" << path("o.csv") << "\": File too large; it holds all until " << kept.back().time << " s\n";
  EXPECT_NE(err.find(until.str()), std::string::npos) << err;
  // The summary had room.
  const double time = summary("s.json")["sim_time"].as<double>();
  EXPECT_GE(time, kept.back().time);
  EXPECT_LT(time, 1000);
  EXPECT_NE(err.find("stopped at " + number_text(time) + " s: "), std::string::npos) << err;
  EXPECT_EQ(parts(), std::vector<std::string>());
}

TEST_F(CableSim, whatComesLateAndDoesNotFitIsCutAfterAWholeTime) {
  const std::string scene = write("scene.yaml", sound_scene);
  EXPECT_EQ(run(scene + " --duration 1 --output " + path("o.csv"), small_disk), 3);
  expect_whole_times(rows("o.csv"));
  EXPECT_EQ(parts(), std::vector<std::string>());
}

/// Not one time is whole: nothing takes the place of what was there.
TEST_F(CableSim, aDiskWithoutRoomForOneTimeLeavesWhatWasThere) {
  const std::string scene = write("scene.yaml", sound_scene);
  write("o.csv", "old");
  EXPECT_EQ(run(scene + " --duration 1 --output " + path("o.csv"), "ulimit -f 1; "), 3);
  EXPECT_NE(err.find("\": File too large\n"), std::string::npos) << err;
  EXPECT_EQ(content(path("o.csv")), "old");
  EXPECT_EQ(parts(), std::vector<std::string>());
}

TEST_F(CableSim, aReaderThatLeavesEndsTheRun) {
  const std::string scene = write("scene.yaml", sound_scene);
  const std::string command = "(" CABLE_SIM_PROGRAM " " + scene + " --duration 1e6 --output /dev/stdout 2> " + path("err") +
                              "; echo $? > " + path("status") + ") | head -n 2 > " + path("out");
  ASSERT_EQ(std::system(command.c_str()), 0);
  EXPECT_EQ(content(path("status")), "3\n");
  EXPECT_NE(content(path("err")).find("cannot write \"/dev/stdout\": Broken pipe"), std::string::npos) << content(path("err"));
  EXPECT_EQ(content(path("out")).rfind("t,cable,node,x,y,z,vx,vy,vz,tension\n0,hose,0,", 0), 0u);
}

TEST_F(CableSim, dataOnStandardOutputIsNotMixedWithText) {
  const std::string scene = write("scene.yaml", sound_scene);
  ASSERT_EQ(run(scene + " --duration 0.1 --summary /dev/stdout"), 0) << err;
  EXPECT_EQ(YAML::Load(out)["sim_time"].as<double>(), 0.1);
  EXPECT_EQ(out.find("real time)"), std::string::npos);
  EXPECT_NE(err.find("real time)"), std::string::npos);

  ASSERT_EQ(run(scene + " --duration 0.1 --output /dev/stdout"), 0) << err;
  const std::string rows = out;
  ASSERT_EQ(run(scene + " --duration 0.1 --output " + path("o.csv")), 0) << err;
  EXPECT_EQ(rows, content(path("o.csv")));
  EXPECT_NE(out.find("real time)"), std::string::npos);

  EXPECT_EQ(run(scene + " --output /dev/stdout --summary /dev/fd/1"), 2);
  EXPECT_NE(err.find("\"/dev/fd/1\" is the output"), std::string::npos) << err;
  EXPECT_EQ(run(scene + " --duration 0 --output /dev/null --summary /dev/null"), 0) << err;
  EXPECT_EQ(run(scene + " --duration 0", "exec >&-; "), 0) << "the shell's redirection opens it again";
}

TEST_F(CableSim, aResultThatCannotBePrintedIsAnError) {
  const std::string command = CABLE_SIM_PROGRAM " " + write("scene.yaml", sound_scene) + " --duration 0 > /dev/full 2>&1";
  const int status = std::system(command.c_str());
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 3);
}

/// A stream that was closed is not replaced by the first file that is opened.
TEST_F(CableSim, standardStreamsMayBeClosed) {
  const std::string command =
      CABLE_SIM_PROGRAM " " + write("scene.yaml", sound_scene) + " --duration 0 --output " + path("o.csv") + " <&- >&- 2>&-";
  const int status = std::system(command.c_str());
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 3);
  EXPECT_EQ(rows("o.csv").size(), 21u);
}

TEST_F(CableSim, namedPipesAreRefused) {
  const std::string scene = write("scene.yaml", sound_scene);
  const std::string pipe = path("pipe");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0666), 0);
  for (const std::string& arguments : {pipe, scene + " --motion " + pipe}) {
    EXPECT_EQ(run(arguments), 2) << arguments;
    EXPECT_NE(err.find(pipe + ": cannot read: it is a named pipe; allowed: a file"), std::string::npos) << err;
  }
  EXPECT_EQ(run(scene + " --output " + pipe + " --summary " + pipe), 2);
  for (const char* option : {"--output", "--summary"})
    EXPECT_NE(err.find(std::string(option) + ": cannot write \"" + pipe + "\": it is a named pipe"), std::string::npos) << err;
}

TEST_F(CableSim, endlessInputIsRefused) {
  const std::string scene = write("scene.yaml", sound_scene);
  EXPECT_EQ(run("/dev/zero"), 2);
  EXPECT_NE(err.find("allowed: at most 16777216"), std::string::npos) << err;
  EXPECT_EQ(run(scene + " --motion /dev/zero"), 2);
  EXPECT_NE(err.find("line 1: too long"), std::string::npos) << err;
  EXPECT_EQ(run(path("")), 2);
  EXPECT_NE(err.find("Is a directory"), std::string::npos) << err;
  EXPECT_EQ(run(scene + " --motion " + path("")), 2);
  EXPECT_NE(err.find("Is a directory"), std::string::npos) << err;
}

TEST_F(CableSim, aSceneMayComeFromAPipeThatIsOpen) {
  const std::string scene = write("scene.yaml", sound_scene);
  EXPECT_EQ(run("/dev/stdin --duration 0 --output " + path("o.csv"), "cat " + scene + " | "), 0) << err;
  EXPECT_EQ(rows("o.csv").size(), 21u);
}

TEST_F(CableSim, atMostAHundredErrorsAreListed) {
  std::string text = sound_scene;
  for (int i = 0; i < 400; ++i) text += "key" + std::to_string(i) + ": 1\n";
  std::string motion = "t,frame,x,y,z,qx,qy,qz,qw\n";
  for (int i = 0; i < 400; ++i) motion += "nan,hand,nan,nan,nan,nan,nan,nan,nan\n";
  const auto lines = [this] { return std::count(err.begin(), err.end(), '\n'); };
  const std::string sound = write("sound.yaml", sound_scene);
  write("m.csv", motion);
  EXPECT_EQ(run(sound + " --motion " + path("m.csv")), 2);
  EXPECT_EQ(lines(), 101) << err;
  write("scene.yaml", text);
  EXPECT_EQ(run(path("scene.yaml") + " --motion " + path("m.csv") + " --rate 0"), 2);
  EXPECT_EQ(lines(), 101) << err;
  EXPECT_NE(err.find("--rate: \"0\""), std::string::npos) << err;
  EXPECT_NE(err.find("more than 100 errors, the first 100 are listed; nothing was simulated"), std::string::npos) << err;
}

}  // namespace
}  // namespace verlet_cable

#include "cable_sim/options.h"
#include "cable_sim/picture_record.h"
#include "cable_sim_fixture.h"
#include "scene/frame_source.h"
#include "scene_text.h"

namespace verlet_cable {
namespace {

using cable_sim::PictureRecord;
using test::joined;
using test::replaced;
using test::sound_scene;

const std::string png_start = "\x89PNG\r\n\x1a\n", gif_start = "GIF89a";

/// As far as the pictures have it: a mass that hangs from a hand, and a box that it does not touch.
const std::string hanging = R"(
time_step: 0.005
materials: {m: {linear_density: 0.1, radius: 0.005, drag: 1.0}}
cables: [{name: rope, length: 1.0, segments: 10, material: m, point_masses: [{at: end, mass: 0.5}],
          attachments: [{name: hand, at: start, frame: hand, initial_pose: [0, 0, 2, 0, 0, 0]}],
          initial: {type: straight, from: [0, 0, 2], to: [0, 0, 1]}}]
obstacles: [{name: floor, type: plane}, {name: box, type: box, size: [0.2, 0.4, 0.6], pose: [1, 0, 0.3, 0, 0, 0]}]
)";

TEST_F(CableSim, drawsWhatItSimulated) {
  const std::string scene = write("scene.yaml", hanging);
  ASSERT_EQ(run(scene + " --duration 0.5 --plot " + path("p.png") + " --gif " + path("a.gif")), 0) << err;
  EXPECT_EQ(err, "");
  EXPECT_EQ(content(path("p.png")).substr(0, png_start.size()), png_start);
  EXPECT_EQ(content(path("a.gif")).substr(0, gif_start.size()), gif_start);
  EXPECT_EQ(parts(), std::vector<std::string>{});
  ASSERT_EQ(run(scene + " --duration 0.5 --movie " + path("b.gif")), 0) << err;
  EXPECT_EQ(content(path("b.gif")), content(path("a.gif")));
  // Nothing moves, and it takes no time.
  ASSERT_EQ(run(scene + " --duration 0 --plot " + path("none.png") + " --gif " + path("none.gif")), 0) << err;
}

TEST_F(CableSim, drawsEveryKindOfThing) {
  const std::string scene = write("scene.yaml", R"(
time_step: 0.005
particles: [{name: p, mass: 0.1, position: [1, 1, 1], velocity: [0, 0, 0]}]
nets: [{name: net, grid: {rows: 3, columns: 3, spacing: 0.1}, mass: 0.1, stiffness: 50}]
obstacles: [{name: can, type: cylinder, radius: 0.1, length: 0.3, pose: [0, 2, 0, 0, 0, 0]},
            {name: pill, type: capsule, radius: 0.1, length: 0.3, pose: [0, 3, 0, 0, 0, 0]},
            {name: ball, type: sphere, radius: 0.1, pose: [0, 4, 0, 0, 0, 0]}]
)");
  ASSERT_EQ(run(scene + " --duration 0.2 --plot " + path("p.png") + " --gif " + path("a.gif")), 0) << err;
  EXPECT_EQ(content(path("p.png")).substr(0, png_start.size()), png_start);
}

TEST_F(CableSim, picturesThatCannotBeAreRefusedBeforeAnythingIsSimulated) {
  const std::string scene = write("scene.yaml", hanging) + " --output " + path("o.csv");
  EXPECT_EQ(run(scene + " --plot " + path("p.jpg") + " --gif " + path("a.png")), 2);
  EXPECT_EQ(err, "cable_sim: --plot: \"" + path("p.jpg") + "\"; allowed: a name that ends in .png\ncable_sim: --gif: \"" +
                     path("a.png") + "\"; allowed: a name that ends in .gif\ncable_sim: 2 errors, nothing was simulated\n");
  EXPECT_EQ(run(scene + " --plot " + path("nowhere/p.png") + " --gif " + path("nowhere/a.gif")), 2);
  EXPECT_NE(err.find("cable_sim: --plot: cannot write \"" + path("nowhere/p.png") + "\": "), std::string::npos) << err;
  EXPECT_NE(err.find("cable_sim: --gif: cannot write \"" + path("nowhere/a.gif") + "\": "), std::string::npos) << err;
  EXPECT_EQ(run(scene + " --summary " + path("s.png") + " --plot " + path("s.png")), 2);
  EXPECT_NE(err.find("cable_sim: --plot: \"" + path("s.png") + "\" is the summary; allowed: another file"), std::string::npos)
      << err;
  // No python3 has it.
  write("matplotlib.py", "raise ImportError('not on this machine')\n");
  const std::string without = "PYTHONPATH=" + path("") + " ";
  EXPECT_EQ(run(scene + " --gif " + path("a.gif"), without), 2);
  EXPECT_NE(err.find("cable_sim: --gif: "), std::string::npos) << err;
  EXPECT_NE(err.find("python3: ImportError: not on this machine"), std::string::npos) << err;
  EXPECT_NE(err.find("; allowed: a python3 that has matplotlib and Pillow (Debian: sudo apt-get install python3-matplotlib)\n"),
            std::string::npos)
      << err;
  EXPECT_NE(err.find("cable_sim: 1 error, nothing was simulated\n"), std::string::npos) << err;
  EXPECT_FALSE(exists("o.csv"));
}

/// As ffmpeg, which may not be there: a program that keeps what it was called with, and takes all pictures.
TEST_F(CableSim, drawsMoviesByFfmpeg) {
  const std::string scene = write("scene.yaml", hanging) + " --duration 0.2 --movie ";
  EXPECT_EQ(run(scene + path("m.avi")), 2);
  EXPECT_NE(err.find("--movie: \"" + path("m.avi") + "\"; allowed: a name that ends in .gif or .mp4\n"), std::string::npos)
      << err;
  // Whoever has python3 beside ffmpeg has both.
  ASSERT_EQ(std::system(("ln -s \"$(command -v python3)\" " + path("python3")).c_str()), 0);
  const std::string only_python = "PATH=" + path("") + ":/bin/nothing ";
  if (access("/usr/bin/ffmpeg", X_OK) != 0) {
    EXPECT_EQ(run(scene + path("m.mp4"), only_python), 2);
    EXPECT_NE(err.find("cable_sim: --movie: OSError: there is no ffmpeg; allowed: a name that ends in .gif, or a PATH that has "
                       "ffmpeg (Debian: sudo apt-get install ffmpeg)\n"),
              std::string::npos)
        << err;
  }
  write("ffmpeg", "#!/bin/sh\nfor last; do :; done\necho \"$@\" > " + path("called") + "\n/bin/cat > \"$last\"\n");
  ASSERT_EQ(std::system(("chmod +x " + path("ffmpeg")).c_str()), 0);
  ASSERT_EQ(run(scene + path("m.mp4"), only_python), 0) << err;
  EXPECT_GT(content(path("m.mp4")).size(), 6 * 4 * 100 * 100u);  // raw pictures
  EXPECT_NE(content(path("called")).find("yuv420p"), std::string::npos);
}

/// What is drawn of so many steps.
YAML::Node recorded(int steps) {
  const SceneDesc scene = read_scene_text(hanging);
  const BoundaryInputs frames = FrameSource(scene, {}).at(0);
  World world(scene, frames);
  PictureRecord record(world, "hanging.yaml", steps);
  for (int i = 0; i < steps; ++i) {
    world.step(frames);
    record.add(world);
  }
  return YAML::Load(record.json());
}

TEST(PictureRecord, hasShapesAndForcesAtEvenTimes) {
  constexpr int steps = 400;
  const YAML::Node json = recorded(steps);
  EXPECT_EQ(json["title"].Scalar(), "hanging.yaml");
  EXPECT_EQ(json["planes"].size(), 1u);
  // 25 a second, and the start.
  ASSERT_EQ(json["frames"].size(), 51u);
  for (int k = 0; k < 51; ++k) EXPECT_NEAR(json["frames"][k]["time"].as<double>(), 0.04 * k, 1e-12);
  EXPECT_EQ(json["frames"][50]["cables"]["rope"].size(), 11u);
  EXPECT_EQ(json["frames"][50]["obstacles"][0].size(), 8u);
  EXPECT_EQ(json["frames"][50]["obstacles"][0][0].as<std::vector<double>>(), (std::vector<double>{0.9, -0.2, 0}));
  // It hangs at rest: the hand bears the weight, between the steps as at their ends.
  const auto forces = json["forces"]["hand"].as<std::vector<double>>();
  ASSERT_EQ(forces.size(), static_cast<std::size_t>(steps));
  ASSERT_EQ(json["times"].size(), forces.size());
  EXPECT_NEAR(json["times"][0].as<double>(), 0.0025, 1e-12);
  for (const double force : forces) EXPECT_NEAR(force, 0.6 * 9.81, 1e-4);
}

TEST(PictureRecord, doesNotGrowWithTheRun) {
  const YAML::Node json = recorded(20000);
  EXPECT_LE(json["frames"].size(), 151u);
  EXPECT_GE(json["frames"].size(), 140u);
  EXPECT_LE(json["times"].size(), 600u);
  EXPECT_GE(json["times"].size(), 550u);
}

}  // namespace
}  // namespace verlet_cable

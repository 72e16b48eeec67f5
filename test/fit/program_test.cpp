#include <sys/stat.h>

#include <cmath>

#include "cable_fit/report.h"
#include "cable_fit_fixture.h"
#include "synthetic.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/scene/scene_reader.h"

namespace verlet_cable::cable_fit {
namespace {

/// Both programs, in a directory of its own.
class CableFit : public CableFitProgram {
 protected:
  std::string write_recording(const std::string& name, const Recording& recording) {
    return write(name, prediction_csv(recording, {true, recording.markers}));
  }
};

std::string vector_text(const Vector3& v) {
  return "[" + number_text(v.x()) + ", " + number_text(v.y()) + ", " + number_text(v.z()) + "]";
}

/// As the README tells users to add them.
std::string initial_and_attachments(const Recording& recording) {
  std::string points, velocities;
  for (const Vector3& marker : recording.markers[0]) points += (points.empty() ? "" : ", ") + vector_text(marker);
  for (const Vector3& velocity : initial_velocities(recording))
    velocities += (velocities.empty() ? "" : ", ") + vector_text(velocity);
  return "    initial: {type: points, points: [" + points + "], velocities: [" + velocities + "]}\n" +
         "    attachments:\n      - {name: a, at: start, frame: start, type: clamp}\n"
         "      - {name: b, at: end, frame: end, type: clamp}\n";
}

std::string motion_csv(const Recording& recording) {
  const HeldEnds ends = held_ends(recording);
  std::string text = "t,frame,x,y,z,qx,qy,qz,qw\n";
  for (const double time : recording.times) {
    for (const auto& [name, track] : {std::pair{"start", &ends.start}, std::pair{"end", &ends.end}}) {
      const Pose pose = track->at(time);
      text += number_text(time) + "," + name;
      for (int axis = 0; axis < 3; ++axis) text += "," + number_text(pose.position[axis]);
      for (int axis = 0; axis < 4; ++axis) text += "," + number_text(pose.orientation.coeffs()[axis]);
      text += "\n";
    }
  }
  return text;
}

TEST_F(CableFit, SceneIsWhatCableSimPredictsWith) {
  const Recording recording = synthetic_recording(known_cable(), 0, 0.4, 5e-4);
  const std::string file = write_recording("take.csv", recording);
  ASSERT_EQ(fit(file + " --name lead --segments 12 --linear-density 0.08 --output " + path("scene.yaml")), 0) << err;
  EXPECT_NE(err.find("cable_fit: note: assumed, as not given: --radius 0.005 m; weigh and measure the cable\n"),
            std::string::npos)
      << err;
  const SceneDesc cable = read_scene_text(content(path("scene.yaml")) + "    attachments: []\n");
  EXPECT_EQ(cable.cables[0].name, "lead");
  EXPECT_EQ(cable.cables[0].segments, 12);
  EXPECT_EQ(cable.materials[0].material.linear_density, 0.08);

  // The same bytes a second time.
  ASSERT_EQ(fit(file + " --name lead --segments 12 --linear-density 0.08 --radius 0.005 --output " + path("again.yaml")), 0)
      << err;
  EXPECT_EQ(err.find("assumed"), std::string::npos) << err;
  EXPECT_EQ(content(path("again.yaml")), content(path("scene.yaml")));

  write("full.yaml", content(path("scene.yaml")) + initial_and_attachments(recording));
  write("motion.csv", motion_csv(recording));
  ASSERT_EQ(run(path("full.yaml") + " --duration 0.4 --motion " + path("motion.csv") + " --output " + path("nodes.csv")), 0)
      << err;
  const std::vector<Row> nodes = rows("nodes.csv");
  ASSERT_EQ(nodes.size(), 13u * recording.rows());
  const std::vector<double> places = marker_places({&recording});
  const Prediction prediction = predict(cable, {places, {}, {}, {}}, recording);
  double gap = 0;
  for (int row = 0; row < recording.rows(); ++row) {
    for (std::size_t i = 0; i < places.size(); ++i) {
      const int segment = std::min(static_cast<int>(places[i] * 12), 11);
      const double fraction = places[i] * 12 - segment;
      const Vector3 simulated =
          (1 - fraction) * nodes[13 * row + segment].position + fraction * nodes[13 * row + segment + 1].position;
      gap = std::max(gap, (simulated - prediction.positions[row][i]).norm());
    }
  }
  // Numbers are written in full: only the orientations' rounding in the file differs.
  EXPECT_LT(gap, 1e-9);
}

TEST_F(CableFit, CentreLineIsASceneAndPredictionsAreRecordings) {
  std::string files;
  for (int take = 0; take < 2; ++take)
    files += write_recording("take" + std::to_string(take) + ".csv",
                             synthetic_recording(known_cable(), take, 0.3, 0, 0, {0, 0, 0.01})) +
             " ";
  ASSERT_EQ(fit(files + " --name lead --segments 8 --output " + path("scene.yaml") + " --centre-line " + path("centre.yaml") +
                " --report " + path("report.json") + " --predictions " + path("predictions/of")),
            0)
      << err;
  const SceneDesc scene = read_scene_text(content(path("centre.yaml")));
  ASSERT_EQ(scene.cables[0].attachments.size(), 2u);
  EXPECT_NE(content(path("centre.yaml")).find("turned the smallest way to x = ["), std::string::npos);
  EXPECT_GT(scene.cables[0].attachments[0].offset.norm(), 1e-3);
  EXPECT_EQ(scene.cables[0].attachments[0].offset.x(), 0);
  for (const char* expected : {"\"centre_line\"", "\"marker_offsets\"", "\"resegmented\"", "\"cross_validated_error\""})
    EXPECT_NE(content(path("report.json")).find(expected), std::string::npos) << expected;
  std::vector<std::string> errors;
  const std::vector<Recording> predicted =
      read_recordings({path("predictions/of/take0.csv"), path("predictions/of/take1.csv")}, errors);
  ASSERT_TRUE(errors.empty()) << errors.front();
  EXPECT_EQ(predicted[0].rows(), 31);
  EXPECT_EQ(predicted[0].marker_count(), 12);

  write("file", "");
  EXPECT_EQ(fit(files + " --name lead --segments 8 --output " + path("scene.yaml") + " --predictions " + path("file")), 2);
  EXPECT_NE(err.find("--predictions: no directory"), std::string::npos) << err;
  EXPECT_EQ(fit(files + " --name lead --segments 8 --output " + path("scene.yaml") + " --predictions " + path("")), 2);
  EXPECT_NE(err.find("take1.csv\" is a recording"), std::string::npos) << err;

  // What is refused makes no directory.
  EXPECT_EQ(fit(files + " --name 1 --segments 8 --output " + path("scene.yaml") + " --predictions " + path("refused/of")), 2);
  EXPECT_FALSE(exists("refused"));
}

/// A cable that stands straight and still tells its length only; the intervals of the others would have no end.
TEST_F(CableFit, WhatIsNotDeterminedHasNoInterval) {
  std::string text = "t";
  for (int i = 0; i < 12; ++i)
    for (const char* axis : {"x", "y", "z"}) text += "," + (axis + std::to_string(i));
  text += "\n";
  for (int row = 0; row < 40; ++row) {
    text += number_text(0.01 * row);
    for (int i = 0; i < 12; ++i) text += ",0,0," + number_text(i * 0.05);
    text += "\n";
  }
  ASSERT_EQ(fit(write("straight.csv", text) + " --name lead --segments 8 --output " + path("scene.yaml")), 0) << err;
  EXPECT_NE(err.find("assumed, as not given: --linear-density 0.1 kg/m, --radius 0.005 m;"), std::string::npos) << err;
  std::istringstream lines(out);
  int untold = 0;
  for (std::string line; std::getline(lines, line);) {
    EXPECT_EQ(line.find("inf"), std::string::npos) << line;
    if (line.find("not determined") == std::string::npos) continue;
    ++untold;
    EXPECT_EQ(line.find(" to "), std::string::npos) << line;
  }
  EXPECT_GT(untold, 0) << out;
}

TEST_F(CableFit, BadInputIsRefusedAllAtOnceAndNothingWritten) {
  const Recording sound = synthetic_recording(known_cable(), 0, 0.2, 0);
  Recording short_start = sound;
  for (Vector3& marker : short_start.markers[0]) marker *= 0.9;
  write("bad.csv", "t,x0\n");
  const std::string good = write_recording("good.csv", sound);
  EXPECT_EQ(fit(good + " " + path("bad.csv") + " missing.csv --name 1 --segments 2.5 --linear-density -1 --sgments 3 --output " +
                path("scene.yaml") + " --report " + good),
            2);
  for (const char* expected :
       {"bad.csv: line 1: header \"t,x0\"", "missing.csv: cannot read", "--name: \"1\"", "--segments: \"2.5\"",
        "--linear-density: \"-1\"", "--sgments: no such option (did you mean", "--report: ", "nothing was fitted"})
    EXPECT_NE(err.find(expected), std::string::npos) << err << "lacks " << expected;
  EXPECT_FALSE(exists("scene.yaml"));
  EXPECT_EQ(fit(""), 2);
  for (const char* expected : {"no recordings", "--name: missing", "--output: missing"})
    EXPECT_NE(err.find(expected), std::string::npos) << err << "lacks " << expected;
  EXPECT_EQ(fit(write_recording("short.csv", short_start) + " --name a --output " + path("scene.yaml")), 2);
  EXPECT_NE(err.find("short.csv: the markers' distances in the first row are"), std::string::npos) << err;
  EXPECT_FALSE(exists("scene.yaml"));
  EXPECT_EQ(fit("--help"), 0);
}

TEST_F(CableFit, FilesAreThereWhenTheyAreWhole) {
  const std::string take = write_recording("take.csv", synthetic_recording(known_cable(), 0, 0.2, 0));
  const std::string start = take + " --name lead --segments 8 --output ";
  write("scene.yaml", "old");
  // A limit on the size of files is a disk that is full: the report does not fit, the scene does.
  write("report.json", "old");
  EXPECT_EQ(fit(start + path("scene.yaml") + " --report " + path("report.json"), "ulimit -f 4; "), 3);
  EXPECT_NE(err.find("cannot write \"" + path("report.json") + "\": File too large"), std::string::npos) << err;
  EXPECT_EQ(content(path("report.json")), "old");
  EXPECT_NE(content(path("scene.yaml")).find("lead"), std::string::npos);
  EXPECT_EQ(parts(), std::vector<std::string>());

  ASSERT_EQ(fit(start + "/dev/stdout"), 0) << err;
  EXPECT_EQ(out, content(path("scene.yaml")));
  EXPECT_NE(err.find("bending_stiffness"), std::string::npos) << err;
}

TEST_F(CableFit, TellsWhatWasWrittenAndHowToSeeIt) {
  const std::string take = write_recording("take.csv", synthetic_recording(known_cable(), 0, 0.2, 0));
  const std::string scene = path("a scene.yaml"), report = path("report.json");
  ASSERT_EQ(fit(take + " --name lead --segments 8 --output '" + scene + "' --report " + report), 0) << err;
  const std::string last = "\nwritten: " + scene + ", " + report +
                           "; see it with: roslaunch verlet_cable replay.launch data:=" + take + " scene:='" + scene + "'\n";
  EXPECT_EQ(out.substr(out.size() - std::min(out.size(), last.size())), last) << out;
  // What standard output takes is no file.
  const std::string renamed = write("take\xff.csv", content(take));
  ASSERT_EQ(fit(renamed + " --name lead --segments 8 --output /dev/stdout --report " + report), 0) << err;
  EXPECT_NE(err.find("\nwritten: " + report + "\n"), std::string::npos) << err;
  // A report is UTF-8, whatever names of files are.
  EXPECT_NE(content(report).find("take\xef\xbf\xbd.csv\""), std::string::npos) << content(report);
}

TEST_F(CableFit, WhatCannotBeWrittenIsRefusedBeforeTheFit) {
  const std::string take = write_recording("take.csv", synthetic_recording(known_cable(), 0, 0.2, 0));
  const std::string other = write_recording("other.csv", synthetic_recording(known_cable(), 1, 0.2, 0));
  const std::string pipe = path("pipe");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0666), 0);
  EXPECT_EQ(fit(take + " " + pipe + " /dev/zero --name lead --output " + pipe), 2);
  for (const std::string& expected : {pipe + ": cannot read: it is a named pipe", "--output: cannot write \"" + pipe,
                                      std::string("/dev/zero: line 1: too long")})
    EXPECT_NE(err.find(expected), std::string::npos) << err << "lacks " << expected;
  std::filesystem::create_directories(path("predictions/take.csv"));
  EXPECT_EQ(fit(take + " " + other + " --name lead --output " + path("scene.yaml") + " --predictions " + path("predictions")), 2);
  EXPECT_NE(err.find("--predictions: cannot write \"" + path("predictions/take.csv") + "\": Is a directory"), std::string::npos)
      << err;
}

TEST_F(CableFit, ASignalEndsItAtOnce) {
  const std::string take = write_recording("take.csv", synthetic_recording(known_cable(), 0, 2, 0));
  const std::string other = write_recording("other.csv", synthetic_recording(known_cable(), 1, 2, 0));
  write("scene.yaml", "old");
  // Fits of 400 segments take minutes. The signal is sent when the program catches it (bit 14 of the mask).
  const std::string command = CABLE_FIT_PROGRAM " " + take + " " + other + " --name lead --segments 400 --report " +
                              path("report.json") + " --output " + path("scene.yaml") + " 2> " + path("err") +
                              " & until [ $((0x$(sed -n 's/^SigCgt:\\t//p' /proc/$!/status) & 0x4000)) != 0 ]; do sleep 0.05; "
                              "done; kill $!; wait $!";
  const int status = std::system(command.c_str());
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 3) << status;
  err = content(path("err"));
  EXPECT_NE(err.find("cable_fit: stopped: ended by SIGTERM"), std::string::npos) << err;
  EXPECT_EQ(content(path("scene.yaml")), "old");
  EXPECT_FALSE(exists("report.json"));
}

// Those that the README fits; config/recordings/README.md has the table.
TEST_F(CableFit, FindsTheHoseOfTheRecordingsThatShip) {
  const std::string recordings = RECORDINGS;
  const SceneDesc truth = read_scene_file(recordings + "/hose.yaml");
  ASSERT_EQ(fit(recordings + "/take1.csv " + recordings + "/take2.csv " + recordings +
                "/take3.csv --name hose --linear-density 0.08 --radius 0.004 --output " + path("fitted.yaml")),
            0)
      << err;
  EXPECT_NE(
      out.find("cables[0].rest_curvature: of 24 numbers, two axes at 12 places along the cable, 24 are not determined by these\n"
               "  recordings: there the unloaded cable may as well be straight; --report FILE lists them\n"),
      std::string::npos)
      << out;
  EXPECT_EQ(out.find("rest_curvature["), std::string::npos) << out;
  const SceneDesc fitted = read_scene_text(content(path("fitted.yaml")) + "    attachments: []\n");
  const auto& found = fitted.materials[0].material;
  const auto& known = truth.materials[0].material;
  EXPECT_NEAR(found.bending_stiffness.front() / known.bending_stiffness.front(), 1, 0.02);
  EXPECT_NEAR(found.torsional_stiffness / known.torsional_stiffness, 1, 0.05);
  EXPECT_NEAR(found.bending_damping / known.bending_damping, 1, 0.1);
  EXPECT_NEAR(found.drag / known.drag, 1, 0.05);
  EXPECT_NEAR(fitted.cables[0].length / truth.cables[0].length, 1, 0.002);
}

}  // namespace
}  // namespace verlet_cable::cable_fit

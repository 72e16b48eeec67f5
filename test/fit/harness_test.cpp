#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cable_fit/harness_fit.h"
#include "cable_fit/report.h"
#include "cable_fit_fixture.h"
#include "synthetic_harness.h"
#include "verlet_cable/scene/scene_reader.h"

namespace verlet_cable::cable_fit {
namespace {

constexpr const char* description =
    "cables:\n"
    "  - {name: trunk, markers: [0, 7], linear_density: 0.08, radius: 0.004}\n"
    "  - {name: branch, markers: [8, 10], from: 3}\n"
    "held: [0, 1, 6, 7]\n";

TEST(HarnessFit, FindsTheMaterialsThatMadeTheRecordings) {
  std::vector<Recording> recordings;
  for (int take = 0; take < 3; ++take) recordings.push_back(synthetic_harness_recording(take, 2.5));
  std::vector<Smoothed> inputs;
  for (const Recording& recording : recordings) inputs.push_back(harness_input(known_markers(), recording));
  HarnessSettings settings;
  settings.harness = known_markers();
  settings.segments = 24;
  int simulations = 0;
  const HarnessProblem problem{recordings, inputs, settings, [&] { ++simulations; }};
  const FittedHarness fitted = fit_harness(problem, {0, 1}, {});
  EXPECT_GT(simulations, 0);
  const SceneDesc found = harness_scene(fitted.settings, settings.segments, fitted.values);
  // Markers are on the chords of the cables, and the branch leaves along the first of its own: few markers tell it roughly.
  EXPECT_NEAR(found.materials[0].material.bending_stiffness.front() / 2e-3, 1, 0.2);
  EXPECT_NEAR(found.materials[1].material.linear_density / 0.04, 1, 0.4);
  EXPECT_GT(found.materials[1].material.bending_stiffness.front(), 2e-3);
  EXPECT_NEAR(found.materials[0].material.bending_damping / 6e-5, 1, 0.35);
  EXPECT_NEAR(found.materials[0].material.drag / 0.02, 1, 0.35);
  EXPECT_NEAR(found.cables[0].length, 0.7, 0.007);
  ASSERT_EQ(found.junctions.size(), 1u);
  EXPECT_NEAR(found.junctions[0].place.arc_length, 0.3, 0.005);
  // The branch leaves at 1.2 rad.
  const Vector3 leaves = quaternion_from_rpy(found.junctions[0].branches[0].rotation) * Vector3::UnitX();
  EXPECT_NEAR(std::acos(leaves.x()), 1.2, 0.15);

  // A recording that the fit did not know.
  const Prediction prediction = predict_harness(fitted.settings, settings.segments, fitted.values, inputs[2].recording);
  EXPECT_TRUE(prediction.sound);
  EXPECT_LT(harness_error(known_markers(), prediction, recordings[2]).root_mean_square, 0.005);
}

TEST(HarnessInput, FlickerOfHeldMarkersIsGoneAndOthersAreAsRecorded) {
  const Recording recording = synthetic_harness_recording(0, 1);
  Recording flickers = recording;
  for (int row = 40; row < 43; ++row) flickers.markers[row][7] += Vector3(0.01, 0, 0.02);
  flickers.markers[60][4] += Vector3(0.01, 0, 0);
  const Smoothed input = harness_input(known_markers(), flickers);
  for (int row = 0; row < recording.rows(); ++row) {
    for (const int marker : {0, 1, 6, 7})
      EXPECT_LT((input.recording.markers[row][marker] - recording.markers[row][marker]).norm(), 0.004) << row << " " << marker;
    for (const int marker : {2, 3, 4, 5, 8, 9, 10})
      EXPECT_EQ(input.recording.markers[row][marker], flickers.markers[row][marker]) << row << " " << marker;
  }
}

/// A harness as it is measured on a recording, of a material that is guessed.
struct Guess {
  explicit Guess(const Recording& recording) : inputs{harness_input(known_markers(), recording)} {
    settings.harness = known_markers();
    settings.segments = 16;
    measure_harness({recording}, inputs, {0}, settings);
    measure_branches(inputs, {0}, settings);
    values = first_harness_guess(settings, 2e-2, 1e-3);
  }
  Prediction predict(const Recording& input) const { return predict_harness(settings, settings.segments, values, input); }

  std::vector<Smoothed> inputs;
  HarnessSettings settings;
  std::vector<double> values;
};

TEST(HarnessPrediction, KnowsNothingOfFreeMarkersBehindTheSecondRow) {
  const Recording recording = synthetic_harness_recording(1, 0.5);
  Recording other = recording;
  for (int row = 2; row < other.rows(); ++row)
    for (const int marker : {2, 3, 4, 5, 8, 9, 10}) other.markers[row][marker] += Vector3(0.1, 0.2, 0.3);
  const Guess guess(recording);
  EXPECT_EQ(guess.predict(guess.inputs[0].recording).positions,
            guess.predict(harness_input(known_markers(), other).recording).positions);
}

TEST(HarnessPrediction, MarkerThatJumpsBetweenTheFirstRowsDoesNotThrowTheCable) {
  const Recording recording = synthetic_harness_recording(0, 0.3);
  const Guess guess(recording);
  const Prediction calm = guess.predict(guess.inputs[0].recording);
  for (const int marker : {4, 10}) {
    Recording jumps = guess.inputs[0].recording;
    jumps.markers[1][marker] += 0.01 * (jumps.markers[0][marker] - jumps.markers[0][marker - 1]).normalized();
    const Prediction thrown = guess.predict(jumps);
    for (int row = 0; row < recording.rows(); ++row)
      for (int i = 0; i < recording.marker_count(); ++i)
        EXPECT_LT((thrown.positions[row][i] - calm.positions[row][i]).norm(), 0.005) << marker << " " << row << " " << i;
  }
}

TEST(HarnessFit, EveryRecordingIsLeftOutOnce) {
  const std::vector<std::vector<int>> parts = left_out_parts(7, 2);
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[0], (std::vector<int>{0, 2, 4, 6}));
  EXPECT_EQ(parts[1], (std::vector<int>{1, 3, 5}));
  EXPECT_EQ(left_out_parts(2, 5).size(), 2u);
}

class HarnessProgram : public CableFitProgram {
 protected:
  std::string take(int number) {
    const Recording recording = synthetic_harness_recording(number, 0.4);
    return write("take" + std::to_string(number) + ".csv", prediction_csv(recording, {true, recording.markers}));
  }
};

TEST_F(HarnessProgram, WritesASceneAReportAndPredictions) {
  const std::string recordings = take(0) + " " + take(1), harness = write("harness.yaml", description);
  ASSERT_EQ(fit(recordings + " --harness " + harness + " --segments 10 --output " + path("scene.yaml") + " --report " +
                path("report.json") + " --predictions " + path("predicted")),
            0)
      << err;
  const SceneDesc scene = read_scene_file(path("scene.yaml"));
  ASSERT_EQ(scene.cables.size(), 2u);
  EXPECT_EQ(scene.cables[1].name, "branch");
  EXPECT_EQ(scene.cables[0].attachments.size(), 2u);
  ASSERT_EQ(scene.junctions.size(), 1u);
  EXPECT_EQ(scene.junctions[0].cable, "trunk");
  EXPECT_NE(content(path("report.json")).find("materials.branch.linear_density"), std::string::npos);
  EXPECT_NE(content(path("report.json")).find("cross_validated_root_mean_square_error"), std::string::npos);
  std::vector<std::string> errors;
  const std::vector<Recording> predicted = read_recordings({path("predicted") + "/take0.csv"}, errors);
  ASSERT_TRUE(errors.empty()) << errors[0];
  EXPECT_EQ(predicted[0].marker_count(), 11);
  EXPECT_NE(out.find("left out of the fit"), std::string::npos);
}

TEST_F(HarnessProgram, NamesAllThatIsWrongWithTheDescription) {
  const std::string harness = write("harness.yaml",
                                    "cables:\n"
                                    "  - {name: trunk, markers: [0, 7], radius: -1}\n"
                                    "  - {name: 5x, markers: [9, 10], of: 3}\n"
                                    "held: [0, nine]\n");
  EXPECT_EQ(fit(take(0) + " --harness " + harness + " --output " + path("scene.yaml")), 2);
  for (const char* part : {"cables[0].radius: -1; allowed: any number above 0 [m]", "cables[1].of: unknown", "held[1]: \"nine\""})
    EXPECT_NE(err.find(part), std::string::npos) << part << "\n" << err;
}

TEST_F(HarnessProgram, NamesMarkersThatAreNotThere) {
  const std::string harness = write("harness.yaml",
                                    "cables:\n"
                                    "  - {name: trunk, markers: [0, 7]}\n"
                                    "  - {name: branch, markers: [9, 10], from: 12}\n"
                                    "held: [0, 1, 10]\n");
  EXPECT_EQ(fit(take(0) + " --name x --harness " + harness + " --output " + path("scene.yaml")), 2);
  EXPECT_NE(err.find("--name: \"x\"; allowed: none"), std::string::npos) << err;
  EXPECT_EQ(fit(take(0) + " --harness " + harness + " --output " + path("scene.yaml")), 2);
  EXPECT_NE(err.find("cables[1].markers: [9, 10]; allowed: from 8 on"), std::string::npos) << err;
  EXPECT_NE(err.find("cables[1].from: 12; allowed"), std::string::npos) << err;
  EXPECT_EQ(
      fit(take(0) + " --harness " + write("short.yaml", "cables:\n  - {name: trunk, markers: [0, 7]}\nheld: [0, 1, 4, 5]\n") +
          " --output " + path("scene.yaml")),
      2);
  EXPECT_NE(err.find("held: marker 4; allowed"), std::string::npos) << err;
}

}  // namespace
}  // namespace verlet_cable::cable_fit

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "cable_fit/confidence.h"
#include "cable_fit/cross_validation.h"
#include "cable_fit/least_squares.h"
#include "synthetic.h"

namespace verlet_cable::cable_fit {
namespace {

std::vector<Smoothed> smooth(const std::vector<Recording>& recordings) {
  std::vector<Smoothed> inputs;
  for (const Recording& recording : recordings) inputs.push_back(smoothed(recording));
  return inputs;
}

TEST(Fit, FindsTheMaterialThatMadeTheRecordings) {
  const SceneDesc known = known_cable();
  std::vector<Recording> recordings;
  for (int take = 0; take < 3; ++take) recordings.push_back(synthetic_recording(known, take, 3, 0));
  const std::vector<Smoothed> inputs = smooth(recordings);
  CableSettings settings;
  settings.name = "found";
  settings.segments = 32;
  settings.linear_density = known.materials[0].material.linear_density;
  std::vector<std::string> errors;
  measure_cable(recordings, inputs, settings, errors);
  ASSERT_TRUE(errors.empty());
  int simulations = 0;
  const Problem problem{recordings, inputs, settings, cable_parameters(settings), [&] { ++simulations; }};
  std::vector<int> all(recordings.size());
  std::iota(all.begin(), all.end(), 0);
  const std::vector<double> values = fit(problem, all, coarse_search(problem, all));
  EXPECT_LE(simulations, most_simulations(problem, 3));

  const SceneDesc found = cable_scene(settings, values);
  const MaterialDesc &is = found.materials[0].material, &should = known.materials[0].material;
  // Places of markers are taken along the chords between them, which cut the bends.
  EXPECT_NEAR(is.bending_stiffness / should.bending_stiffness, 1, 0.05);
  EXPECT_NEAR(is.bending_damping / should.bending_damping, 1, 0.05);
  EXPECT_NEAR(is.drag / should.drag, 1, 0.05);
  EXPECT_NEAR(found.cables[0].length, known.cables[0].length, 0.003);

  const std::vector<Confidence> confident = confidence(problem, values);
  ASSERT_EQ(confident.size(), values.size());
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(confident[i].told) << problem.parameters[i].key;
    EXPECT_LT(confident[i].half_width, 0.1) << problem.parameters[i].key;
    EXPECT_GT(confident[i].half_width, 0) << problem.parameters[i].key;
  }
}

TEST(Fit, CableThatHangsStillDoesNotTellItsDampings) {
  Recording still = synthetic_recording(known_cable(), 0, 0, 0);
  while (still.rows() < 40) {
    still.times.push_back(0.01 * still.rows());
    still.markers.push_back(still.markers.front());
  }
  CableSettings settings;
  settings.name = "still";
  settings.segments = 12;
  std::vector<std::string> errors;
  const std::vector<Recording> recordings{still};
  const std::vector<Smoothed> inputs = smooth(recordings);
  measure_cable(recordings, inputs, settings, errors);
  const Problem problem{recordings, inputs, settings, cable_parameters(settings), [] {}};
  const std::vector<Confidence> confident = confidence(problem, fit(problem, {0}, coarse_search(problem, {0})));
  // In the order of the parameters: bending_damping, drag.
  EXPECT_FALSE(confident[2].told);
}

TEST(CrossValidation, LeavesEveryRecordingOutOnce) {
  EXPECT_EQ(left_out_together(8), (std::vector<std::vector<int>>{{0, 1}, {2, 3}, {4, 5}, {6, 7}}));
  EXPECT_EQ(left_out_together(7), (std::vector<std::vector<int>>{{0, 1}, {2, 3}, {4, 5}, {6}}));
  EXPECT_EQ(left_out_together(3), (std::vector<std::vector<int>>{{0}, {1}, {2}}));
}

TEST(PredictionError, IsTheMeanOverLaterRowsMarkersAndCoordinates) {
  Recording recording;
  recording.times = {0, 0.01, 0.02, 0.03};
  recording.markers.assign(4, std::vector<Vector3>(2, Vector3::Zero()));
  Prediction prediction;
  prediction.positions = recording.markers;
  prediction.positions[0][0] = {9, 9, 9};  // given, not predicted
  prediction.positions[2][1] = {0.3, -0.6, 0};
  prediction.positions[3][0] = {0, 0, 0.12};
  const PredictionError error = prediction_error(prediction, recording);
  EXPECT_NEAR(error.mean, 1.02 / 12, 1e-15);
  EXPECT_EQ(error.largest, 0.6);
  EXPECT_NEAR(error.last, 0.02, 1e-15);
}

}  // namespace
}  // namespace verlet_cable::cable_fit

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <numeric>

#include "cable_fit/cross_validation.h"
#include "cable_fit/errors_in_variables.h"
#include "cable_fit/least_squares.h"
#include "known_rod.h"
#include "synthetic.h"

namespace verlet_cable::cable_fit {
namespace {

std::vector<Smoothed> smooth(const std::vector<Recording>& recordings) {
  std::vector<Smoothed> inputs;
  for (const Recording& recording : recordings) inputs.push_back(smoothed(recording));
  return inputs;
}

std::vector<int> all_of(const std::vector<Recording>& recordings) {
  std::vector<int> all(recordings.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

TEST(Fit, FindsTheMaterialThatMadeTheRecordings) {
  const SceneDesc known = known_cable();
  std::vector<Recording> recordings;
  for (int take = 0; take < 3; ++take) recordings.push_back(synthetic_recording(known, take, 5, 0));
  const std::vector<Smoothed> inputs = smooth(recordings);
  CableSettings settings;
  settings.name = "found";
  settings.segments = 32;
  settings.linear_density = known.materials[0].material.linear_density;
  const std::vector<int> all = all_of(recordings);
  measure_cable(recordings, inputs, all, settings);
  std::vector<std::string> errors;
  check_starts(recordings, inputs, settings, errors);
  ASSERT_TRUE(errors.empty());
  int simulations = 0;
  const Problem problem{recordings, inputs, settings, cable_parameters(settings), [&] { ++simulations; }};
  const std::vector<double> start = coarse_search(problem, all);
  const int searched = simulations;
  const std::vector<double> values = fit(problem, all, start);
  EXPECT_LE(simulations, most_simulations(problem, 3));
  // Slopes take most of them: after the search they are found at nine places or fewer.
  EXPECT_LT(simulations - searched, 3 * 9 * static_cast<int>(problem.parameters.size() + 1));

  const SceneDesc found = cable_scene(settings, values);
  const MaterialDesc &is = found.materials[0].material, &should = known.materials[0].material;
  // Places of markers are taken along the chords between them, which cut the bends.
  EXPECT_NEAR(is.bending_stiffness.front() / should.bending_stiffness.front(), 1, 0.05);
  EXPECT_NEAR(is.bending_damping / should.bending_damping, 1, 0.05);
  EXPECT_NEAR(is.drag / should.drag, 1, 0.05);
  EXPECT_NEAR(found.cables[0].length, known.cables[0].length, 0.003);

  simulations = 0;
  const Estimate estimate = with_input_errors(problem, all, values, for_parameters.corrections);
  EXPECT_LE(simulations, most_simulations_with_input_errors(problem, all, for_parameters.corrections));
  ASSERT_EQ(estimate.values.size(), values.size());
  ASSERT_EQ(estimate.confidence.size(), values.size());
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(estimate.confidence[i].told) << problem.parameters[i].key;
    EXPECT_LT(estimate.confidence[i].half_width, 0.1) << problem.parameters[i].key;
    EXPECT_GT(estimate.confidence[i].half_width, 0) << problem.parameters[i].key;
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
  const std::vector<Recording> recordings{still};
  const std::vector<Smoothed> inputs = smooth(recordings);
  measure_cable(recordings, inputs, {0}, settings);
  const Problem problem{recordings, inputs, settings, cable_parameters(settings), [] {}};
  const Estimate estimate = with_input_errors(problem, {0}, fit(problem, {0}, coarse_search(problem, {0})), 1);
  // In the order of the parameters: bending_damping, drag.
  EXPECT_FALSE(estimate.confidence[2].told);
}

/// Of a rod that another program has simulated: what noise does to the hands' motion is not taken for a property of the material.
TEST(Fit, SeesARodThroughTheNoiseOfItsMarkers) {
  // As coarse as this the other program's rod is stiffer by two percent.
  constexpr int rod_segments = 40;
  std::vector<Recording> recordings;
  for (unsigned take = 0; take < 4; ++take)
    recordings.push_back(with_noise(recording_of_rod(1 + take, 1, 2, rod_segments), 0.002, take));
  const FoundRod rod = find_rod(recordings, 24);
  const double allowed[] = {0.1, 0.2, 0.15, 0.5};
  for (std::size_t i = 0; i < std::size(allowed); ++i) {
    const double difference = rod.estimate.values[i] - value_of_rod(i);
    EXPECT_NEAR(std::pow(10, difference), 1, allowed[i]) << rod.parameters[i].key;
    EXPECT_LT(std::abs(difference), rod.estimate.confidence[i].half_width + 0.01) << rod.parameters[i].key;
  }
  EXPECT_TRUE(rod.estimate.confidence[0].told);
  for (std::size_t i = 0; i < rod.parameters.size(); ++i)
    if (rod.parameters[i].key.find("rest_curvature") != std::string::npos) {
      EXPECT_FALSE(rod.estimate.confidence[i].told) << rod.parameters[i].key << " " << rod.estimate.values[i];
    }
}

TEST(Fit, IsTheSameHoweverManyThreadsThereAre) {
  const std::vector<Recording> recordings{with_noise(recording_of_rod(1, 1, 0.5, 40), 0.002, 1)};
  const auto found = [&] { return find_rod(recordings, 8).estimate.values; };
  std::vector<double> alone;
  tbb::task_arena(1).execute([&] { alone = found(); });
  EXPECT_EQ(found(), alone);
}

TEST(Fit, FindsHowFarMarkersSitOffTheCentreLine) {
  const SceneDesc known = known_cable();
  const Vector3 hand_offset(0, -0.01, 0.005);
  std::vector<Recording> recordings;
  for (int take = 0; take < 3; ++take) recordings.push_back(synthetic_recording(known, take, 3, 0, 0, hand_offset));
  const std::vector<Smoothed> inputs = smooth(recordings);
  const std::vector<int> all = all_of(recordings);
  CableSettings settings;
  settings.name = "found";
  settings.segments = 24;
  settings.linear_density = known.materials[0].material.linear_density;
  measure_cable(recordings, inputs, all, settings);
  const Problem on_markers{recordings, inputs, settings, cable_parameters(settings), [] {}};
  const std::vector<double> line = fit(on_markers, all, coarse_search(on_markers, all), for_predictions);
  settings.centre_line = true;
  const Problem beside{recordings, inputs, settings, cable_parameters(settings), [] {}};
  const std::vector<double> values = fit(beside, all, with_markers_on_line(settings, line), for_predictions);

  const auto error = [&](const Problem& problem, const std::vector<double>& found) {
    double sum = 0;
    for (const PredictionError& one :
         prediction_errors(std::vector<FittedCable>(recordings.size(), {problem.settings, found}), recordings))
      sum += one.mean / static_cast<double>(recordings.size());
    return sum;
  };
  EXPECT_LT(error(beside, values), 0.3 * error(on_markers, line));
  EXPECT_LT(error(beside, values), 0.001);
  // Alike offsets of all would only move the cable: those of markers on hands and between differ.
  const Markers markers = markers_of(settings, values);
  const auto off = [&](std::size_t marker) { return Vector3(0, markers.offsets[marker][0], markers.offsets[marker][1]); };
  for (const std::size_t marker : {0, 1, 10, 11}) EXPECT_NEAR(off(marker).norm(), hand_offset.norm(), 0.002) << marker;
  for (std::size_t marker = 2; marker < 10; ++marker) EXPECT_LT(off(marker).norm(), 0.003) << marker;
  const double found = cable_scene(settings, values).materials[0].material.bending_stiffness.front();
  EXPECT_NEAR(found / known.materials[0].material.bending_stiffness.front(), 1, 0.05);
}

TEST(Fit, CurvatureOfZeroGoesByTheSameLawAsOthers) {
  const Recording recording = synthetic_recording(known_cable(), 0, 1, 0);
  CableSettings settings;
  settings.name = "found";
  settings.segments = 16;
  const std::vector<Recording> recordings{recording};
  measure_cable(recordings, smooth(recordings), {0}, settings);
  const std::vector<double> straight = first_guess(settings, 1e-2, 1e-3);
  std::vector<double> curved = straight;
  const std::vector<Parameter> parameters = cable_parameters(settings);
  for (std::size_t i = 0; i < parameters.size(); ++i)
    if (parameters[i].key.find("rest_curvature") != std::string::npos) curved[i] = 1e-7;
  const Markers markers = markers_of(settings, straight);
  const Prediction one = predict(cable_scene(settings, straight), markers, recording),
                   other = predict(cable_scene(settings, curved), markers, recording);
  double gap = 0;
  for (int row = 0; row < recording.rows(); ++row)
    for (int marker = 0; marker < recording.marker_count(); ++marker)
      gap = std::max(gap, (one.positions[row][marker] - other.positions[row][marker]).norm());
  EXPECT_LT(gap, 1e-6);
}

TEST(Markers, OnTheLineThroughThemNothingChanges) {
  const Recording recording = synthetic_recording(known_cable(), 1, 0.3, 0);
  CableSettings settings;
  settings.name = "found";
  settings.segments = 16;
  const std::vector<Recording> recordings{recording};
  measure_cable(recordings, smooth(recordings), {0}, settings);
  const std::vector<double> line = first_guess(settings, 1e-2, 1e-3);
  EXPECT_TRUE(markers_of(settings, line).offsets.empty());
  settings.centre_line = true;
  const std::vector<double> values = with_markers_on_line(settings, line);
  ASSERT_EQ(values.size(), cable_parameters(settings).size());
  const Markers markers = markers_of(settings, values);
  ASSERT_EQ(markers.offsets.size(), 12u);
  for (const auto& offset : markers.offsets) EXPECT_EQ(std::hypot(offset[0], offset[1]), 0);
  EXPECT_EQ(markers.places, settings.marker_places);
  // The markers on the hands are given.
  const Prediction prediction = predict(cable_scene(settings, values), markers, recording);
  for (int row = 0; row < recording.rows(); ++row)
    for (const int marker : {0, 1, 10, 11})
      EXPECT_LT((prediction.positions[row][marker] - recording.markers[row][marker]).norm(), 1e-9) << row << ", " << marker;
}

TEST(CrossValidation, KnowsNothingOfWhatItLeavesOut) {
  std::vector<Recording> recordings;
  for (int take = 0; take < 3; ++take) recordings.push_back(synthetic_recording(known_cable(), take, 0.2, 0));
  CableSettings settings;
  settings.name = "found";
  settings.segments = 8;
  const auto folds = [&] {
    const std::vector<Smoothed> inputs = smooth(recordings);
    measure_cable(recordings, inputs, {0, 1, 2}, settings);
    const Problem problem{recordings, inputs, settings, cable_parameters(settings), [] {}};
    return left_out_fits(problem, {});
  };
  const FittedCable before = folds()[0];
  // Another first recording, of a cable that is a little longer, changes nothing of the fit that leaves it out.
  for (std::vector<Vector3>& markers : recordings[0].markers)
    for (Vector3& marker : markers) marker *= 1.01;
  const FittedCable after = folds()[0];
  EXPECT_EQ(before.values, after.values);
  EXPECT_EQ(before.settings.marker_places, after.settings.marker_places);
  EXPECT_EQ(before.settings.length, after.settings.length);
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

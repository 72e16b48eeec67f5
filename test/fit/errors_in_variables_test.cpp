#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numeric>

#include "cable_fit/bent_places.h"
#include "cable_fit/cable_parameters.h"
#include "cable_fit/input_errors.h"
#include "cable_fit/supposed.h"
#include "known_rod.h"
#include "synthetic.h"

namespace verlet_cable::cable_fit {
namespace {

/// Chords of an arc are shorter than it the more, the longer they are.
TEST(BentPlaces, AreWhereAnArcHasThem) {
  constexpr double radius = 0.3, length = 0.9;
  const std::vector<double> places{0, 0.05, 0.4, 0.55, 1};
  Prediction arc;
  std::vector<Vector3>& row = arc.positions.emplace_back();
  std::vector<double> chords{0};
  for (const double place : places) {
    const double angle = place * length / radius;
    row.emplace_back(radius * std::cos(angle), 0, radius * std::sin(angle));
    if (row.size() > 1) chords.push_back(chords.back() + (row.back() - row[row.size() - 2]).norm());
  }
  std::vector<double> measured;
  for (const double chord : chords) measured.push_back(chord / chords.back());
  EXPECT_GT(std::abs(measured[3] - places[3]), 0.01);
  const std::vector<double> along = places_along(measured, places, {arc});
  for (std::size_t i = 0; i < places.size(); ++i) EXPECT_NEAR(along[i], places[i], 1e-12) << i;
}

/// With one standard normal number at a time, squares of samples add up to the covariance: the inverse of the information, of
/// what is supposed; of the others, what of their covariance is due to it.
TEST(Supposed, SamplesHaveTheCovarianceThatIsLeft) {
  Eigen::MatrixXd slopes(6, 5);
  slopes << 1, 2, 0, 1, 3, 0, 1, 1, 2, 1, 2, 0, 1, 1, 0, 1, 1, 3, 0, 2, 0, 3, 1, 1, 1, 1, 0, 2, 2, 1;
  const Eigen::MatrixXd information = slopes.transpose() * slopes + Eigen::MatrixXd::Identity(5, 5);
  const Eigen::MatrixXd covariance = information.inverse();
  const Supposed supposed(information, 2);
  Eigen::MatrixXd squares = Eigen::MatrixXd::Zero(5, 5);
  for (int i = 0; i < 2; ++i) {
    const Eigen::VectorXd sample = supposed.likeliest_with(Eigen::VectorXd::Unit(2, i));
    squares += sample * sample.transpose();
  }
  EXPECT_LT((squares.rightCols(2) - covariance.rightCols(2)).cwiseAbs().maxCoeff(), 1e-12);
  const Eigen::MatrixXd alone = information.topLeftCorner(3, 3).inverse();
  EXPECT_LT((squares.topLeftCorner(3, 3) - (covariance.topLeftCorner(3, 3) - alone)).cwiseAbs().maxCoeff(), 1e-12);
}

/// Of differences exp(value) x u with an unknown u, which has the information exp(2 value) x.x / variance + known.
TEST(Supposed, PullIsHalfTheDerivativeOfTheDeterminantsLogarithm) {
  const Eigen::Vector3d x(0.5, -2, 1.5);
  constexpr double value = 0.3, variance = 0.04, known = 7;
  const auto half_logarithm = [&](double at) { return 0.5 * std::log(std::exp(2 * at) * x.squaredNorm() / variance + known); };
  const double u = 1 / std::sqrt(std::exp(2 * value) * x.squaredNorm() / variance + known);
  const Eigen::MatrixXd slopes = std::exp(value) * x * u;
  const Eigen::VectorXd pull = pull_of(slopes, -slopes, std::exp(value) * x * u, variance);
  constexpr double step = 1e-4;
  EXPECT_NEAR(pull[0], (half_logarithm(value + step) - half_logarithm(value - step)) / (2 * step), 1e-7);
}

/// Predictions that go on from where their input differs first are the same as those that begin at the start.
TEST(Waypoints, LeadToThePredictionsOfTheWholeWay) {
  const Recording recording = synthetic_recording(known_cable(), 1, 0.8, 0.001);
  CableSettings settings;
  settings.name = "found";
  settings.segments = 12;
  const std::vector<Recording> recordings{recording};
  const std::vector<Smoothed> inputs{smoothed(recording)};
  measure_cable(recordings, inputs, {0}, settings);
  const std::vector<double> values = first_guess(settings, 1e-2, 1e-3);
  const SceneDesc scene = cable_scene(settings, values);
  const Markers markers = markers_of(settings, values);
  const InputErrors errors(recording, inputs[0], 1e-6);
  int later = 0;
  for (Eigen::Index k = 0; k < errors.count(); ++k) {
    const int row = errors.first_row(k) - rows_ahead;
    if (row < 0) continue;
    ++later;
    const Waypoints waypoints = predict_by({row}, scene, markers, errors.changed(Eigen::VectorXd::Zero(errors.count())));
    const Input changed = errors.changed(2 * Eigen::VectorXd::Unit(errors.count(), k));
    const Prediction whole = predict(scene, markers, changed);
    ASSERT_EQ(predict_on(waypoints, 0, scene, markers, changed).positions, whole.positions) << k;
    ASSERT_NE(waypoints.prediction.positions, whole.positions) << k;
  }
  EXPECT_GT(later, errors.count() / 3);
}

/// What is seen of damping where hands move slowly is how the noise of the start decays: it seemed to be determined, four times
/// too large.
TEST(SlowHands, DoNotTellHowBendingIsDamped) {
  enum { stiffness, damping };
  for (const double pace : {0.12, 1.0}) {
    std::vector<Recording> recordings;
    for (const unsigned take : {0U, 1U})
      recordings.push_back(with_noise(recording_of_rod(101 + take, pace, 2, 48), 0.002, 1000 + take));
    const FoundRod rod = find_rod(recordings, 24);
    const std::vector<Confidence>& confidence = rod.estimate.confidence;
    EXPECT_TRUE(confidence[stiffness].told) << pace;
    EXPECT_LT(std::abs(rod.estimate.values[stiffness] - value_of_rod(stiffness)), confidence[stiffness].half_width) << pace;
    EXPECT_EQ(confidence[damping].told, pace == 1.0) << pace;
    if (confidence[damping].told) {
      EXPECT_LT(std::abs(rod.estimate.values[damping] - value_of_rod(damping)), confidence[damping].half_width);
    }
  }
}

}  // namespace
}  // namespace verlet_cable::cable_fit

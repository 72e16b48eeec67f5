#include "cable_fit/smoothing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace verlet_cable::cable_fit {
namespace {

/// Markers that move smoothly, and some rows that are missing.
Recording swinging_markers(double noise) {
  Recording recording;
  std::mt19937 random(1);
  std::normal_distribution<double> scatter(0, 1);
  for (int row = 0; row < 400; ++row) {
    if (row % 17 == 5 || (row > 200 && row < 205)) continue;
    const double t = 0.01 * row;
    recording.times.push_back(t);
    std::vector<Vector3>& markers = recording.markers.emplace_back();
    for (int i = 0; i < 6; ++i) markers.emplace_back(0.1 * i + 0.05 * std::sin(6 * t), 0.1 * std::cos(4 * t + i), 0.2 * t);
    for (Vector3& marker : markers)
      for (int axis = 0; axis < 3; ++axis) marker[axis] += noise * scatter(random);
  }
  return recording;
}

double root_mean_square(const Recording& a, const Recording& b) {
  double sum = 0;
  for (int row = 0; row < a.rows(); ++row)
    for (int i = 0; i < a.marker_count(); ++i) sum += (a.markers[row][i] - b.markers[row][i]).squaredNorm();
  return std::sqrt(sum / (3 * a.rows() * a.marker_count()));
}

TEST(Smoothing, FindsTheNoiseAndTakesMostOfItAway) {
  const Recording still = swinging_markers(0), noisy = swinging_markers(0.002);
  const Smoothed smooth = smoothed(noisy);
  EXPECT_NEAR(smooth.noise, 0.002, 1e-4);
  EXPECT_LT(root_mean_square(smooth.recording, still), 0.3 * root_mean_square(noisy, still));
}

TEST(Smoothing, TakesAnyNumberOfMarkersOfAHarnessThatAreHeld) {
  for (const int count : {1, 2, 3, 4, 5}) {
    Recording still = swinging_markers(0), noisy = swinging_markers(0.002);
    for (Recording* recording : {&still, &noisy})
      for (std::vector<Vector3>& markers : recording->markers) markers.resize(count);
    const Smoothed smooth = smoothed(noisy);
    EXPECT_NEAR(smooth.noise, 0.002, 2e-4) << count;
    EXPECT_LT(root_mean_square(smooth.recording, still), 0.3 * root_mean_square(noisy, still)) << count;
  }
}

TEST(Smoothing, LeavesWhatHasNoNoise) {
  const Recording still = swinging_markers(0);
  const Smoothed smooth = smoothed(still);
  EXPECT_LT(smooth.noise, 1e-5);
  EXPECT_LT(root_mean_square(smooth.recording, still), 1e-5);
  EXPECT_EQ(smooth.recording.times, still.times);
}

}  // namespace
}  // namespace verlet_cable::cable_fit

#include "cable_fit/recording.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <fstream>

#include "verlet_cable/core/rotation.h"

namespace verlet_cable::cable_fit {
namespace {

const std::string header = "t,x0,y0,z0,x1,y1,z1,x2,y2,z2,x3,y3,z3\n";

std::string row(const std::string& time, const std::string& x1 = "0.1") {
  return time + ",0,0,0," + x1 + ",0,0,0.5,0,-0.1,0.6,0,0\n";
}

std::string rows(int count) {
  std::string text;
  for (int i = 0; i < count; ++i) text += row(std::to_string(0.5 + 0.01 * i));
  return text;
}

class Recordings : public testing::Test {
 protected:
  std::string write(const std::string& text) {
    const std::string path = testing::TempDir() + "recording_" + std::to_string(getpid()) + "_" + std::to_string(paths_.size());
    std::ofstream(path) << text;
    return paths_.emplace_back(path);
  }
  ~Recordings() override {
    for (const std::string& path : paths_) std::remove(path.c_str());
  }

  std::string errors_of(const std::vector<std::string>& paths) {
    std::vector<std::string> errors;
    read_recordings(paths, errors);
    std::string text;
    for (const std::string& error : errors) text += error + "\n";
    return text;
  }
  void expect_error(const std::string& text, const std::string& expected) {
    const std::string path = write(text), errors = errors_of({path});
    EXPECT_NE(errors.find(path + ": " + expected), std::string::npos) << errors << "instead of " << expected;
  }

  std::vector<std::string> paths_;
};

TEST_F(Recordings, AreReadFromTimeZero) {
  std::vector<std::string> errors;
  const std::vector<Recording> recordings = read_recordings({write(header + rows(12))}, errors);
  ASSERT_TRUE(errors.empty());
  EXPECT_EQ(recordings[0].rows(), 12);
  EXPECT_EQ(recordings[0].marker_count(), 4);
  EXPECT_EQ(recordings[0].times[0], 0);
  EXPECT_NEAR(recordings[0].times[11], 0.11, 1e-12);
  EXPECT_EQ(recordings[0].markers[3][2], Vector3(0.5, 0, -0.1));
}

TEST_F(Recordings, SayWhatIsWrong) {
  EXPECT_NE(errors_of({"/no/such/file.csv"}).find("/no/such/file.csv: cannot read: No such file"), std::string::npos);
  expect_error("", "empty; allowed: the header t,x0,y0,z0,x1,... and rows");
  expect_error("a,b\n", "line 1: header \"a,b\"; allowed: t,x0,y0,z0");
  expect_error("t,x0,y0,z0,x1,y1,z1,x2,y2,z2\n" + rows(12), "line 1: header");
  expect_error(header, "0 rows; allowed: 10 or more");
  expect_error(header + rows(9), "9 rows; allowed: 10 or more");
  expect_error(header + rows(11) + row("0.9", "nan"), "line 13: x1 \"nan\"; allowed: finite numbers");
  expect_error(header + rows(11) + row("0.9", "inf"), "line 13: x1 \"inf\"; allowed: finite numbers");
  expect_error(header + rows(11) + row("0.9", ""), "line 13: x1 \"\"; allowed: finite numbers");
  expect_error(header + rows(11) + row("0.6"), "line 13: t 0.6; allowed: times that ascend");
  expect_error(header + rows(11) + "0.9,1,2\n", "line 13: 3 columns; allowed: 13, as the header has");
  expect_error(header + rows(11) + row("0.9", "0"), "line 13: markers 0 and 1 at the same place; allowed: two places");
}

TEST_F(Recordings, TimesThatCannotBeMeantAreRefused) {
  const std::string far = write(header + rows(11) + row("1e6"));
  EXPECT_EQ(errors_of({far}), far + ": 1000000 s long in all; allowed: at most 10000 s\n");
  const std::string half = write(header + rows(11) + row("6000"));
  EXPECT_EQ(errors_of({half}), "");
  EXPECT_EQ(errors_of({half, half}), "the recordings: 11999 s long in all; allowed: at most 10000 s\n");
  expect_error(header + rows(11) + row("0.600000000001", "0.2"), "line 13: marker 1 moves at 1e+11 m/s since the row before, ");
}

TEST_F(Recordings, AreBoundedInAll) {
  const std::string half = write(header + rows(160'000)), other = write(header + rows(160'000));
  EXPECT_EQ(errors_of({half}), "");
  const std::string errors = errors_of({half, other});
  EXPECT_NE(errors.find(other + ": line 147694: too many numbers; allowed: at most 4000000 in all recordings"), std::string::npos)
      << errors;
}

TEST_F(Recordings, AllErrorsAreSaidAtOnce) {
  const std::string five = "t,x0,y0,z0,x1,y1,z1,x2,y2,z2,x3,y3,z3,x4,y4,z4\n";
  std::string five_rows;
  for (int i = 0; i < 10; ++i) five_rows += std::to_string(i) + ",0,0,0,1,0,0,2,0,0,3,0,0,4,0,0\n";
  const std::string errors =
      errors_of({write(header + rows(12)), write(five + five_rows), write(header + row("x", "y") + row("1") + row("0.5"))});
  for (const char* expected : {"5 markers; allowed: 4, as in", "t \"x\"", "x1 \"y\"", "t 0.5; allowed: times that ascend"})
    EXPECT_NE(errors.find(expected), std::string::npos) << errors << "lacks " << expected;
}

Recording straight_recording() {
  Recording recording;
  for (int i = 0; i < 20; ++i) {
    recording.times.push_back(0.01 * i);
    recording.markers.push_back({{0, 0, 0}, {0.1, 0, 0}, {0.5, 0, -0.1}, {0.6, 0, 0}, {0.7, 0.001 * i, 0}});
  }
  return recording;
}

TEST(Recording, EndsAreHeldInTheOuterMarkersWithTheSmallestRoll) {
  const HeldEnds ends = held_ends(straight_recording());
  EXPECT_EQ(ends.start.at(0).position, Vector3(0, 0, 0));
  EXPECT_TRUE(ends.start.at(0).orientation.isApprox(Quaternion::Identity()));
  const Pose last = ends.end.at(0.19);
  EXPECT_EQ(last.position, Vector3(0.7, 0.019, 0));
  // From row to row about z alone: nothing rolls.
  const Quaternion expected(Eigen::AngleAxisd(std::atan2(0.019, 0.1), Vector3::UnitZ()));
  EXPECT_TRUE(last.orientation.isApprox(expected, 1e-12));
}

TEST(Recording, RollOfHandsIsTheSmallestFromTheUsualDirection) {
  Recording recording = straight_recording();
  for (std::vector<Vector3>& markers : recording.markers) markers[1] = {0, 0.03, -0.1};
  const HeldDirections usual{-Vector3::UnitZ(), Vector3::UnitX()};
  const Quaternion down = smallest_rotation(Vector3::UnitX(), usual[0]);
  const Quaternion tilt(Eigen::AngleAxisd(std::atan2(0.03, 0.1), Vector3::UnitX()));
  EXPECT_TRUE(held_ends(recording, usual).start.at(0).orientation.isApprox(tilt * down, 1e-12));
  EXPECT_TRUE(held_ends(recording, usual).end.at(0).orientation.isApprox(held_ends(recording).end.at(0).orientation, 1e-12));
}

/// Whose first hand goes round and comes back, so far from +x [rad].
Recording hand_goes_round(double angle) {
  Recording recording;
  for (int row = 0; row <= 40; ++row) {
    const double around = M_PI * row / 20;
    recording.times.push_back(0.01 * row);
    const Vector3 held(std::cos(angle), std::sin(angle) * std::cos(around), std::sin(angle) * std::sin(around));
    recording.markers.push_back({{0, 0, 0}, 0.1 * held, {0.5, 0, -0.1}, {0.6, 0, 0}});
  }
  return recording;
}

TEST(Recording, HandThatComesBackHasTheRollThatItHad) {
  const HeldDirections usual{Vector3::UnitX(), Vector3::UnitX()};
  const auto rolled = [](const HeldEnds& ends) {
    return ends.start.at(0).orientation.angularDistance(ends.start.at(0.4).orientation);
  };
  EXPECT_LT(rolled(held_ends(hand_goes_round(0.5), usual)), 1e-9);
  // Carried along it rolls by the solid angle that it has gone round.
  EXPECT_NEAR(rolled(held_ends(hand_goes_round(0.5))), 2 * M_PI * (1 - std::cos(0.5)), 0.02);
  // Near the opposite direction the smallest turn from the usual one would whirl round: no row differs much from the one before.
  const HeldEnds far = held_ends(hand_goes_round(3), usual);
  for (int row = 0; row < 40; ++row)
    EXPECT_LT(far.start.at(0.01 * row).orientation.angularDistance(far.start.at(0.01 * (row + 1)).orientation), 0.05) << row;
}

TEST(Recording, UsualDirectionsAreTheMeanOnes) {
  Recording along_y = straight_recording();
  for (std::vector<Vector3>& markers : along_y.markers) markers[1] = {0, 0.2, 0};
  const Recording along_x = straight_recording();
  EXPECT_TRUE(usual_directions({&along_x, &along_y})[0].isApprox(Vector3(1, 1, 0).normalized(), 1e-12));
}

TEST(Recording, SwappedMarkersAreSeenAndPutInOrder) {
  const Recording sound = straight_recording();
  EXPECT_FALSE(swapped_ends(sound).any());
  const Recording wrong = in_order(sound, {false, true});
  EXPECT_FALSE(swapped_ends(wrong).start);
  EXPECT_TRUE(swapped_ends(wrong).end);
  EXPECT_EQ(in_order(wrong, swapped_ends(wrong)).markers, sound.markers);
  EXPECT_TRUE(swapped_ends(in_order(sound, {true, false})).start);
}

TEST(Recording, LengthIsTheMedianOverTheRows) {
  Recording recording = straight_recording();
  const double length = measured_length(recording);
  recording.markers[5][2] = {3, 0, 0};  // a marker that was taken for another
  EXPECT_NEAR(measured_length(recording), length, 1e-3);
}

TEST(Recording, PlacesOfMarkersAreMediansOverTheRowsOfAll) {
  Recording even, bent;
  for (int i = 0; i < 2; ++i) even.markers.push_back({{0, 0, 0}, {0.1, 0, 0}, {0.5, 0, 0}, {1, 0, 0}});
  bent.markers.push_back({{0, 0, 0}, {0.1, 0, 0}, {0.2, 0, 0}, {1, 0, 0}});
  const std::vector<double> places = marker_places({&even, &bent});
  ASSERT_EQ(places.size(), 4u);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(places[i], even.markers[0][i].x(), 1e-15);
}

}  // namespace
}  // namespace verlet_cable::cable_fit

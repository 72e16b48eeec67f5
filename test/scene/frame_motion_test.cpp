#include <gtest/gtest.h>

#include <fstream>

#include "scene_text.h"
#include "verlet_cable/scene/frame_speed.h"
#include "verlet_cable/scene/motion.h"

namespace verlet_cable {
namespace {

/// Rounding of sums of a few numbers near 1.
constexpr double rounding = 1e-14;

Quaternion turned(double angle) {
  return Quaternion(Eigen::AngleAxisd(angle, Vector3::UnitZ()));
}

/// Reads the text as a motion file; its errors, and the motion if there are none.
std::vector<std::string> read(const std::string& text, Motion* motion = nullptr) {
  const std::string path = testing::TempDir() + "frame_motion_test.csv";
  std::ofstream(path, std::ios::binary) << text;
  try {
    const Motion result = read_motion_file(path);
    if (motion) *motion = result;
  } catch (const SceneError& error) {
    return error.errors();
  }
  return {};
}

const std::string header = "t,frame,x,y,z,qx,qy,qz,qw\n";

TEST(FrameTrack, isHeldBeforeTheFirstAndAfterTheLastPose) {
  FrameTrack track;
  track.add(1, {{1, 2, 3}, turned(0.1)});
  EXPECT_EQ(track.at(0).position, Vector3(1, 2, 3));
  EXPECT_EQ(track.at(5).position, Vector3(1, 2, 3));
  track.add(2, {{4, 5, 6}, turned(0.5)});
  EXPECT_EQ(track.at(-3).position, Vector3(1, 2, 3));
  EXPECT_EQ(track.at(2).position, Vector3(4, 5, 6));
  EXPECT_EQ(track.at(9).position, Vector3(4, 5, 6));
  EXPECT_EQ(track.at(9).orientation.coeffs(), turned(0.5).coeffs());
}

TEST(FrameTrack, twoPosesAreJoinedByAStraightLineAndAnEvenTurn) {
  FrameTrack track;
  track.add(0, {{0, 0, 0}, turned(0)});
  track.add(2, {{1, 0, 4}, turned(1)});
  EXPECT_NEAR((track.at(0.5).position - Vector3(0.25, 0, 1)).norm(), 0, rounding);
  EXPECT_NEAR(track.at(0.5).orientation.angularDistance(turned(0.25)), 0, 1e-7);  // acos near 1 keeps half the digits
}

TEST(FrameTrack, quadraticMotionIsFollowedExactlyOverUnequalIntervals) {
  const auto position = [](double t) { return Vector3(1 + 2 * t - 3 * t * t, t, -t * t); };
  FrameTrack track;
  for (const double t : {0.0, 0.5, 0.8, 2.0, 2.1, 3.0}) track.add(t, {position(t), Quaternion::Identity()});
  // Between the inner poses, where both tangents are central.
  for (double t = 0.5; t <= 2.1; t += 0.01) EXPECT_NEAR((track.at(t).position - position(t)).norm(), 0, 20 * rounding) << t;
}

TEST(FrameTrack, velocityIsContinuous) {
  FrameTrack track;
  for (const auto& [t, x] : {std::pair{0.0, 0.0}, {1.0, 1.0}, {1.5, -1.0}, {3.0, 0.5}})
    track.add(t, {{x, 0, 0}, Quaternion::Identity()});
  constexpr double h = 1e-6;
  for (const double t : {1.0, 1.5}) {
    const double before = (track.at(t).position.x() - track.at(t - h).position.x()) / h;
    const double after = (track.at(t + h).position.x() - track.at(t).position.x()) / h;
    EXPECT_NEAR(before, after, 1e-4) << t;  // the acceleration is some 10, times h, and rounding / h
  }
}

TEST(FrameTrack, turnsTheShortWay) {
  FrameTrack track;
  Quaternion other_sign = turned(0.2);
  other_sign.coeffs() *= -1;
  track.add(0, {Vector3::Zero(), turned(0)});
  track.add(1, {Vector3::Zero(), other_sign});
  EXPECT_NEAR(track.at(0.5).orientation.angularDistance(turned(0.1)), 0, 1e-7);
}

TEST(MotionFile, framesComeInAnyOrder) {
  Motion motion;
  EXPECT_TRUE(
      read(header + "0,a,0,0,0,0,0,0,1\n1, b ,5,0,0,0,0,0,2\r\n\n1,a,2,0,0,0,0,0,1\n0.5,c,1e-1,0,0,0,0,0.7,0.7\n", &motion)
          .empty());
  ASSERT_EQ(motion.size(), 3u);
  EXPECT_NEAR(motion["a"].at(0.5).position.x(), 1, rounding);
  EXPECT_EQ(motion["b"].at(0).position.x(), 5);
  EXPECT_NEAR(motion["c"].at(0).orientation.norm(), 1, rounding);
}

TEST(MotionFile, everyErrorHasItsLine) {
  const auto errors = read(header +
                           "0,a,0,0,0,0,0,0,1\n"
                           "0.1,a,nan,0,0,0,0,inf,1\n"
                           "0.2,a,0,0,0,0,0,0,0\n"
                           "0,a,0,0,0,0,0,0,1\n"
                           "0,a,0,0,0,0,0,0\n"
                           "0.3,/a,0,0,0,0,0,0,1\n"
                           "x,,0,0,0,0,0,0,1\n"
                           "0.4,a,1e10,0,0,0,0,0,1\n");
  const char* starts[] = {"line 3: x \"nan\"; allowed: ",
                          "line 3: qz \"inf\"; allowed: ",
                          "line 4: quaternion of length 0; allowed: ",
                          "line 5: t 0 of \"a\"; allowed: times that ascend, the frame's last one is 0",
                          "line 6: 8 columns; allowed: 9",
                          "line 7: frame \"/a\"; allowed: ",
                          "line 8: t \"x\"; allowed: ",
                          "line 8: frame \"\"; allowed: ",
                          "line 9: x \"1e10\"; allowed: "};
  ASSERT_EQ(errors.size(), std::size(starts)) << test::joined(errors);
  for (std::size_t i = 0; i < errors.size(); ++i) EXPECT_EQ(errors[i].rfind(starts[i], 0), 0u) << errors[i];
}

TEST(MotionFile, filesThatAreNoMotionAreRefused) {
  EXPECT_TRUE(test::has_line(read(""), "empty"));
  EXPECT_TRUE(test::has_line(read("t,x,y,z\n0,0,0,0\n"), "line 1: header \"t,x,y,z\"; allowed: t,frame,"));
  EXPECT_TRUE(test::has_line(read(header), "no rows"));
  EXPECT_TRUE(test::has_line(read(header + std::string(100000, '1')), "line 2: too long"));
  EXPECT_EQ(read(header +
                 [] {
                   std::string rows;
                   for (int i = 0; i < 1000; ++i) rows += "x\n";
                   return rows;
                 }())
                .size(),
            101u);
  EXPECT_THROW(read_motion_file("/nonexistent/motion.csv"), SceneError);
  EXPECT_THROW(read_motion_file("/"), SceneError);
}

TEST(FrameSpeed, holdsBackWhatIsTooFast) {
  BoundaryInputs before(3);
  BoundaryInputs frames(3);
  frames[0].pose.position = {0.1, 0, 0};
  frames[1].pose = {{0, 0.4, 0}, turned(0.4)};
  frames[2].pose.position = {5, 0, 0};
  frames[2].known = false;
  EXPECT_EQ(limit_frame_motion(before, 0.1, frames), std::vector<int>{1});
  EXPECT_EQ(frames[0].pose.position, Vector3(0.1, 0, 0));
  EXPECT_NEAR((frames[1].pose.position - Vector3(0, 0.1, 0)).norm(), 0, rounding);
  EXPECT_NEAR(frames[1].pose.orientation.angularDistance(turned(0.1)), 0, 1e-7);  // acos near 1 keeps half the digits
  EXPECT_EQ(frames[2].pose.position, Vector3(5, 0, 0));
  EXPECT_TRUE(limit_frame_motion(before, infinity, frames).empty());
}

}  // namespace
}  // namespace verlet_cable

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <random>

#include "scene/frame_speed.h"
#include "scene_text.h"
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

TEST(FrameTrack, quadraticMotionIsFollowedExactlyOverEqualIntervals) {
  const auto position = [](double t) { return Vector3(1 + 2 * t - 3 * t * t, t, -t * t); };
  FrameTrack track;
  for (const double t : {0.0, 0.5, 1.0, 1.5, 2.0, 2.5}) track.add(t, {position(t), Quaternion::Identity()});
  // Between the inner poses, where both tangents are central.
  for (double t = 0.5; t <= 2; t += 0.01) EXPECT_NEAR((track.at(t).position - position(t)).norm(), 0, 20 * rounding) << t;
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

/// Random numbers for tracks, the same on every machine.
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double operator()(double lowest, double highest) {
    return lowest + (highest - lowest) * static_cast<double>(engine_()) / static_cast<double>(std::mt19937::max());
  }

 private:
  std::mt19937 engine_;
};

FrameTrack along_x(const std::vector<double>& times, const std::vector<double>& places) {
  FrameTrack track;
  for (std::size_t i = 0; i < times.size(); ++i) track.add(times[i], {{places[i], 0, 0}, Quaternion::Identity()});
  return track;
}

TEST(FrameTrack, aQuickStepBetweenTwoRestsStaysBetweenThem) {
  for (const double quick : {1e-2, 1e-4, 1e-9, 1e-300}) {
    const FrameTrack track = along_x({-1, 0, quick, 1}, {0, 0, 0.1, 0.1});
    for (double t = -1.1; t < 1.1; t += 1e-3) {
      const double x = track.at(t).position.x();
      EXPECT_GE(x, 0) << quick << " " << t;
      EXPECT_LE(x, 0.1) << quick << " " << t;
      if (t <= 0) {
        EXPECT_EQ(x, 0) << quick << " " << t;
      }
      if (t >= quick) {
        EXPECT_EQ(x, 0.1) << quick << " " << t;
      }
    }
  }
}

TEST(FrameTrack, rowsThatGoOneWayNeverTurnBackAndWhatStandsStands) {
  Random random(7);
  for (int trial = 0; trial < 2000; ++trial) {
    std::vector<double> times{0}, places{0};
    const int rows = 2 + trial % 8;
    while (static_cast<int>(times.size()) < rows) {
      times.push_back(times.back() + std::pow(10, random(-5, 1)));
      places.push_back(places.back() + (random(0, 1) < 0.3 ? 0 : std::pow(10, random(-5, 1))));
    }
    const FrameTrack track = along_x(times, places);
    double before = 0;
    for (std::size_t i = 0; i + 1 < times.size(); ++i) {
      for (int k = 0; k <= 50; ++k) {
        const double t = times[i] + k / 50.0 * (times[i + 1] - times[i]);
        const double x = track.at(t).position.x();
        ASSERT_GE(x, before - 1e-15 * places.back()) << trial << " " << t;
        if (places[i] == places[i + 1]) {
          ASSERT_EQ(x, places[i]) << trial << " " << t;
        }
        before = std::max(before, x);
      }
    }
  }
}

TEST(FrameTrack, theSplineDoesNotDependOnUnitsOrAxes) {
  Random random(3);
  const Quaternion turn = Quaternion(Eigen::AngleAxisd(1.1, Vector3(1, 2, 3).normalized()));
  const Vector3 shift(0.3, -2, 5);
  for (int trial = 0; trial < 200; ++trial) {
    FrameTrack track, changed, mirrored;
    std::vector<std::pair<double, Vector3>> rows;
    for (double t = 0; rows.size() < 6; t += random(0.01, 1))
      rows.emplace_back(t, Vector3(random(-1, 1), random(-1, 1), random(-1, 1)));
    for (const auto& [t, x] : rows) {
      track.add(t, {x, Quaternion::Identity()});
      changed.add(8 * t, {shift + 4 * (turn * x), Quaternion::Identity()});
    }
    for (auto row = rows.rbegin(); row != rows.rend(); ++row) mirrored.add(-row->first, {row->second, Quaternion::Identity()});
    for (double t = -0.1; t < rows.back().first + 0.1; t += 0.01) {
      const Vector3 x = track.at(t).position;
      ASSERT_NEAR((changed.at(8 * t).position - shift - 4 * (turn * x)).norm(), 0, 10 * rounding) << t;
      ASSERT_NEAR((mirrored.at(-t).position - x).norm(), 0, 10 * rounding) << t;
    }
  }
}

TEST(FrameTrack, uniformMotionIsExactOverUnequalIntervals) {
  FrameTrack track;
  const Vector3 velocity(1, -2, 0.5);
  for (const double t : {-1.0, 0.0, 0.01, 0.8, 5.0}) track.add(t, {t * velocity, turned(0.3 * t)});
  for (double t = -1; t < 5; t += 0.01) {
    EXPECT_NEAR((track.at(t).position - t * velocity).norm(), 0, 20 * rounding) << t;
    EXPECT_NEAR((track.velocity_from(t).linear - velocity).norm(), 0, 1e-11) << t;  // rounding over the shortest interval
    EXPECT_NEAR((track.velocity_from(t).angular - Vector3(0, 0, 0.3)).norm(), 0, 1e-11) << t;
  }
}

TEST(FrameTrack, velocityIsThatOfTheMotionThatBegins) {
  Random random(5);
  FrameTrack track;
  for (int i = 0; i < 8; ++i)
    track.add(0.3 * i + random(0, 0.2), {{random(-1, 1), random(-1, 1), random(-1, 1)},
                                         Quaternion(random(-1, 1), random(-1, 1), random(-1, 1), random(-1, 1)).normalized()});
  constexpr double h = 1e-6;
  for (double t = 0.2; t < 2; t += 0.0137) {
    const Pose now = track.at(t), next = track.at(t + h);
    // Curvatures of some 100 m/s^2 over h, and the rounding of places over h.
    EXPECT_NEAR((track.velocity_from(t).linear - (next.position - now.position) / h).norm(), 0, 1e-3) << t;
    const Vector3 turn = rotation_vector(next.orientation * now.orientation.conjugate());
    EXPECT_NEAR((track.velocity_from(t).angular - turn / h).norm(), 0, 1e-3) << t;
  }
  EXPECT_EQ(track.velocity_from(-0.1).linear, Vector3(0, 0, 0));
  EXPECT_EQ(track.velocity_from(track.last_time()).linear, Vector3(0, 0, 0));
  FrameTrack one;
  one.add(0, {});
  EXPECT_EQ(one.velocity_from(0).linear, Vector3(0, 0, 0));
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

TEST(MotionFile, framesAreBounded) {
  std::string rows = header;
  for (int i = 0; i < 20002; ++i) rows += "0,f" + std::to_string(i) + ",0,0,0,0,0,0,1\n";
  const auto errors = read(rows);
  ASSERT_EQ(errors.size(), 2u);
  EXPECT_EQ(errors[0], "line 20002: frame \"f20000\"; allowed: at most 20000 frames");
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

TEST(FrameSpeed, slowsDownVelocitiesThatAreTooGreat) {
  BoundaryInputs frames(3);
  frames[1].velocity = FrameVelocity{{0, 20, 0}, {0, 0, 4}};
  frames[2].velocity = FrameVelocity{{0, 0, 1}, {9, 0, 0}};
  limit_frame_velocities(1, frames);
  EXPECT_FALSE(frames[0].velocity);
  EXPECT_NEAR((frames[1].velocity->linear - Vector3(0, 1, 0)).norm(), 0, rounding);
  EXPECT_NEAR((frames[1].velocity->angular - Vector3(0, 0, 0.2)).norm(), 0, rounding);
  EXPECT_EQ(frames[2].velocity->linear, Vector3(0, 0, 1));
  EXPECT_EQ(frames[2].velocity->angular, Vector3(9, 0, 0));
}

}  // namespace
}  // namespace verlet_cable

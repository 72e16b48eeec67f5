#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "../support/scenes.h"

namespace verlet_cable {
namespace {

using Status = StepResult::Status;
constexpr double gravity = 9.81, density = 0.1, load = 0.7, radius = 0.05, length = 2;
constexpr double acceleration = 1;  // [m/s^2] of the winch
constexpr double bounce = 0.02;     // [m/s] left from how the rope found its place

struct WinchCase {
  std::string name;
  GuideDesc::Type guide;
  double distance;  ///< [m] of the winch from the guide
  double speed;     ///< [m/s]
  double wound;     ///< [m] paid out, < 0: taken in
  bool at_end = false;
};

/// An inextensible rope from a winch straight to a guide at the origin, behind which a load hangs.
SceneDesc lift(const WinchCase& winch) {
  SceneDesc scene = scenes::one_cable(60, length);
  const bool on_wheel = winch.guide == GuideDesc::Type::sheave;
  const double arc = on_wheel ? 0.5 * M_PI * radius : 0, top = on_wheel ? radius : 0;
  std::vector<Vector3>& points = scene.cables[0].initial.points;
  points = {{-winch.distance, 0, top}, {0, 0, top}};
  for (int i = 1; on_wheel && i <= 12; ++i) {
    const double angle = 0.5 * M_PI * i / 12;
    points.push_back({radius * std::sin(angle), 0, radius * std::cos(angle)});
  }
  points.push_back({top, 0, winch.distance + arc - length});
  if (winch.at_end) std::reverse(points.begin(), points.end());
  scene.cables[0].initial.type = InitialShapeDesc::Type::points;
  using At = PlaceDesc::At;
  scene.cables[0].attachments = {scenes::attachment("winch", winch.at_end ? At::end : At::start, {-winch.distance, 0, top})};
  scene.cables[0].point_masses = {scenes::payload(load)};
  scene.cables[0].point_masses[0].place.at = winch.at_end ? At::start : At::end;
  GuideDesc& guide = scene.guides.emplace_back();
  guide.name = "guide";
  guide.cable = "cable";
  guide.type = winch.guide;
  const double place = winch.distance + 0.5 * arc;
  guide.place = PlaceDesc{At::arc_length, winch.at_end ? length - place : place};
  if (on_wheel) {
    guide.radius = radius;
    guide.rotation = {0.5 * M_PI, 0, 0};
  }
  return scene;
}

class WinchBesideAGuide : public testing::TestWithParam<WinchCase> {};

TEST_P(WinchBesideAGuide, movesALoadWithoutJerks) {
  const WinchCase& winch = GetParam();
  World world(lift(winch), {});
  const CableState& cable = world.cables()[0].state;
  // The rope finds its place on the guide first.
  for (int i = 0; i < 100; ++i) ASSERT_EQ(world.step({}).status, Status::ok) << i;
  const auto height = [&] { return cable.positions[winch.at_end ? 0 : cable.segments()].z(); };
  const auto wound = [&] { return cable.length() - length; };
  const double start = height(), weight = gravity * (load + density * length);
  ASSERT_TRUE(world.apply(edit::SetLength{0, winch.at_end, length + winch.wound, winch.speed}).ok);
  const double duration = std::abs(winch.wound) / winch.speed + winch.speed / acceleration;
  for (int i = 0; i < static_cast<int>(duration / world.time_step()); ++i) {
    ASSERT_EQ(world.step({}).status, Status::ok) << world.time() << " s";
    const auto [least, most] = std::minmax_element(cable.tension.begin(), cable.tension.end());
    ASSERT_LT(std::max(-*least, *most), 2 * weight) << world.time() << " s";
    // The load's energy is that of the winch's motion: it is as high as the rope that is wound lets it be, and as fast.
    ASSERT_NEAR(height(), start - wound(), 2e-3) << world.time() << " s";
    const double speed = cable.velocities[winch.at_end ? 0 : cable.segments()].norm();
    ASSERT_LT(speed, winch.speed + bounce) << world.time() << " s";
  }
  EXPECT_NEAR(height(), start - winch.wound, 0.01 * std::abs(winch.wound));
}

std::vector<WinchCase> winches() {
  std::vector<WinchCase> cases;
  for (const auto& [kind, type] : {std::pair{"Wheel", GuideDesc::Type::sheave}, std::pair{"Eyelet", GuideDesc::Type::eyelet}})
    for (const auto& [place, distance] : {std::pair{"Near", 0.12}, std::pair{"Far", 0.5}})
      for (const auto& [pace, speed, length] : {std::tuple{"Fast", 0.3, 0.9}, std::tuple{"Slow", 0.05, 0.15}})
        for (const auto& [way, side] : {std::pair{"In", -1.0}, std::pair{"Out", 1.0}})
          for (const bool at_end : {false, true})
            cases.push_back({std::string(kind) + place + pace + way + (at_end ? "AtEnd" : "AtStart"), type, distance, speed,
                             side * length, at_end});
  return cases;
}

/// An eyelet that rubs, too.
TEST(WinchBesideAnEyelet, drawsNoMoreThanWhatRubs) {
  for (const double distance : {0.12, 0.5}) {
    SceneDesc scene = lift({"", GuideDesc::Type::eyelet, distance, 0.3, -0.9});
    scene.guides[0].friction = 0.3;
    World world(scene, {});
    for (int i = 0; i < 100; ++i) ASSERT_EQ(world.step({}).status, Status::ok) << i;
    ASSERT_TRUE(world.apply(edit::SetLength{0, false, length - 0.9, 0.3}).ok);
    const double most = (gravity + acceleration) * (load + density * length) * std::exp(0.3 * M_PI / 2);
    while (world.time() < 3) {
      ASSERT_EQ(world.step({}).status, Status::ok) << world.time() << " s";
      const std::vector<double>& tension = world.cables()[0].state.tension;
      ASSERT_LT(*std::max_element(tension.begin(), tension.end()), 1.1 * most) << world.time() << " s";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Cables, WinchBesideAGuide, testing::ValuesIn(winches()),
                         [](const auto& info) { return info.param.name; });

/// Over an eyelet on which the rope sticks, from a winch that keeps another tension than the load has: nothing moves.
TEST(KeptTensionBesideAGuide, StandsWhereTheRopeSticks) {
  for (const bool at_end : {false, true})
    for (const double kept : {20.0, 22.0, 25.0})
      for (const auto& [segments, time_step] :
           {std::pair{60, 1e-3}, std::pair{60, 2e-3}, std::pair{60, 5e-3}, std::pair{30, 2e-3}}) {
        SceneDesc scene = lift({"", GuideDesc::Type::eyelet, 1.4, 0, 0, at_end});
        scene.time_step = time_step;
        scene.cables[0].segments = segments;
        scene.cables[0].point_masses[0].mass = 2;
        scene.guides[0].friction = 0.3;
        World world(scene, {});
        ASSERT_TRUE(world.apply(edit::SetTension{0, at_end, kept, 2, 1, 3}).ok);
        const CableState& cable = world.cables()[0].state;
        const auto beside = [&](bool winch) { return winch == at_end ? cable.tension.back() : cable.tension.front(); };
        const double hanging = gravity * (2 + 0.5 * density * length / segments);
        for (int i = 0; i * time_step < 0.3; ++i) {
          ASSERT_EQ(world.step({}).status, Status::ok) << i;
          ASSERT_NEAR(beside(true), kept, 0.01 * kept) << i << ' ' << at_end << ' ' << segments << ' ' << time_step;
          ASSERT_NEAR(beside(false), hanging, 0.01 * hanging) << i << ' ' << at_end << ' ' << segments << ' ' << time_step;
        }
      }
}

}  // namespace
}  // namespace verlet_cable

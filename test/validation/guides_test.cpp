#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "../support/analytic_catenary.h"
#include "../support/scenes.h"
#include "validation.h"

namespace verlet_cable::validation {
namespace {

constexpr double gravity = 9.81;

GuideDesc guide(const std::string& name, double at, const Vector3& offset, double friction = 0) {
  GuideDesc desc;
  desc.name = name;
  desc.cable = "cable";
  desc.place = PlaceDesc{PlaceDesc::At::arc_length, at};
  desc.offset = offset;
  desc.friction = friction;
  return desc;
}

GuideDesc sheave(const std::string& name, double at, const Vector3& offset, double radius) {
  GuideDesc desc = guide(name, at, offset, infinity);
  desc.type = GuideDesc::Type::sheave;
  desc.rotation = {0.5 * M_PI, 0, 0};
  desc.radius = radius;
  return desc;
}

double sum(const std::vector<double>& values) {
  double total = 0;
  for (const double value : values) total += value;
  return total;
}

/// Two loads on a rope over what is in the middle.
SceneDesc two_loads(int segments, double length, double at_start, double at_end) {
  SceneDesc scene = scenes::one_cable(segments, length);
  scene.cables[0].point_masses = {scenes::payload(at_start), scenes::payload(at_end)};
  scene.cables[0].point_masses[0].place.at = PlaceDesc::At::start;
  return scene;
}

/// x'' = a + k^2 x from rest, as the rope's weight follows.
double way_of_atwood(double drive, double mass, double density, double time) {
  const double k = std::sqrt(2 * density * gravity / mass);
  return drive / mass / (k * k) * (std::cosh(k * time) - 1);
}

TEST(Atwood, WheelWithInertiaAndBearing) {
  constexpr double m1 = 1, m2 = 1.2, length = 2, radius = 0.05, inertia = 1e-3, bearing = 0.02, time = 0.4;
  const auto samples = sample({40, 80}, [&](int n) {
    SceneDesc scene = two_loads(n, length, m1, m2);
    scene.guides = {sheave("wheel", 0.5 * length, Vector3::Zero(), radius)};
    scene.guides[0].inertia = inertia;
    scene.guides[0].bearing_friction = bearing;
    Simulation run(scene);
    const double start = run.positions().back().z();
    run.run(time);
    const double mass = m1 + m2 + 0.1 * length + inertia / (radius * radius);
    const double way = way_of_atwood((m2 - m1) * gravity - bearing / radius, mass, 0.1, time);
    return std::abs((start - run.positions().back().z()) / way - 1);
  });
  report("Atwood's machine, wheel with inertia and bearing friction", samples, 2e-3, Order::none);
}

TEST(Atwood, StandsWithinTheBearingsFriction) {
  SceneDesc scene = two_loads(40, 2, 1, 1.01);
  scene.guides = {sheave("wheel", 1, Vector3::Zero(), 0.05)};
  scene.guides[0].bearing_friction = 0.01 * gravity * 0.05 * 1.02;
  Simulation run(scene);
  run.run(0.5);
  EXPECT_NEAR(run.world.guides()[0].flow, 0, 1e-9);
  scene.guides[0].bearing_friction = 0.01 * gravity * 0.05 * 0.98;
  Simulation moving(scene);
  moving.run(0.5);
  EXPECT_GT(moving.world.guides()[0].flow, 1e-4);
}

TEST(Atwood, FrictionlessEyeletKeepsEnergyWhileNodesPass) {
  SceneDesc scene = two_loads(50, 2, 1, 1.2);
  scene.guides = {guide("eye", 1, Vector3::Zero())};
  Simulation run(scene);
  const double mass = sum(run.cable().state.masses), energy = run.world.energy().total();
  run.run(0.01);
  double last = run.world.view_guide(0).tension[0], largest_jump = 0;
  for (int i = 0; i < 890; ++i) {
    run.step();
    const GuideView view = run.world.view_guide(0);
    EXPECT_NEAR(view.tension[1], view.tension[0], 1e-4 * last);
    largest_jump = std::max(largest_jump, std::abs(view.tension[0] - last) / last);
    last = view.tension[0];
  }
  EXPECT_LT(largest_jump, 1e-4);
  EXPECT_LT(run.world.view_guide(0).arc_length, 0.7);
  EXPECT_NEAR(sum(run.cable().state.masses), mass, 1e-12);
  EXPECT_NEAR(run.cable().state.length(), 2, 1e-9);
  EXPECT_NEAR(run.world.energy().total(), energy, 1e-8 * run.world.energy().kinetic);
}

/// Of steel wire rope, over an ideal wheel: what passes is strained as it was.
TEST(Atwood, ElasticRopesLoseNothing) {
  constexpr double m1 = 1, m2 = 1.2, length = 3, density = 0.064, radius = 0.06, time = 0.8;
  const auto error = [&](int segments, double stiffness, double time_step) {
    SceneDesc scene = two_loads(segments, length, m1, m2);
    scene.time_step = time_step;
    MaterialDesc& rope = scene.materials[0].material;
    rope.linear_density = density;
    rope.axial_stiffness = stiffness;
    rope.axial_damping = 1e-4 * stiffness;
    scene.guides = {sheave("wheel", 0.5 * length, Vector3::Zero(), radius)};
    Simulation run(scene);
    const double start = run.positions().back().z();
    run.run(time);
    const double way = way_of_atwood((m2 - m1) * gravity, m1 + m2 + density * length, density, time);
    return std::abs((start - run.positions().back().z()) / way - 1);
  };
  // The loads bounce on the rope at first, at rest on average.
  for (const double stiffness : {1e5, 6e5, 1e7})
    report("Atwood's machine, elastic rope", sample({60, 120, 240}, [&](int n) { return error(n, stiffness, 1e-3); }), 2e-3,
           Order::none);
  for (const double time_step : {5e-4, 2e-3}) EXPECT_LT(error(120, 6e5, time_step), 2e-3) << time_step;
}

/// A weightless elastic rope drawn through an eyelet, turning by `turn` [rad]; its end moves away.
struct Capstan {
  Capstan(double friction, double turn, double stretch) : turn(turn) {
    SceneDesc scene = scenes::one_cable(60, 2);
    scene.gravity.acceleration.setZero();
    scene.materials[0].material.axial_stiffness = 1e3;
    scene.materials[0].material.axial_damping = 10;
    scene.materials[0].material.linear_density = 0.01;
    const Vector3 from = 1.01 * Vector3(std::cos(turn), 0, std::sin(turn));
    direction = Vector3::UnitX();
    scene.cables[0].attachments = {scenes::attachment("held", PlaceDesc::At::start, -from),
                                   scenes::attachment("drawn", PlaceDesc::At::end, 1.01 * direction, "")};
    scene.cables[0].attachments[1].offset = Vector3::Zero();
    scene.cables[0].attachments[1].frame = "hand";
    scene.cables[0].attachments[1].initial_pose = InitialPose{1.01, 0, 0, 0, 0, 0};
    scene.cables[0].initial.type = InitialShapeDesc::Type::points;
    scene.cables[0].initial.points = {-from, Vector3::Zero(), 1.01 * direction};
    scene.guides = {guide("eye", 1, Vector3::Zero(), friction)};
    run = std::make_unique<Simulation>(scene);
    draw(stretch);
  }

  void draw(double stretch) {
    constexpr int steps = 2000;
    for (int i = 1; i <= steps; ++i) {
      const double part = static_cast<double>(i) / steps;
      run->inputs[1].pose.position = (1.01 + stretch * part * part * (3 - 2 * part)) * direction;
      run->step();
    }
    run->run(0.5);
  }

  double ratio() const {
    const GuideView view = run->world.view_guide(0);
    return view.tension[1] / view.tension[0];
  }

  double turn;
  Vector3 direction;
  std::unique_ptr<Simulation> run;
};

TEST(Capstan, HoldsAndSlips) {
  for (const double friction : {0.1, 0.3, 0.6}) {
    for (const double degrees : {30.0, 90.0, 170.0}) {
      const double turn = degrees * M_PI / 180, limit = std::exp(friction * turn);
      // At first 10 N on both sides; drawn until nearly as much more as holds.
      Capstan holding(friction, turn, 0.0101 * 0.98 * (limit - 1));
      EXPECT_NEAR(holding.run->world.view_guide(0).arc_length, 1, 1e-4) << friction << " " << degrees;
      EXPECT_GT(holding.ratio(), 1 + 0.95 * (limit - 1));
      Capstan slipping(friction, turn, 0.0101 * 1.5 * (limit - 1));
      EXPECT_LT(slipping.run->world.view_guide(0).arc_length, 1 - 1e-4);
      EXPECT_NEAR(slipping.ratio() / limit, 1, 5e-3) << friction << " " << degrees;
    }
  }
}

/// Of a chain from the origin to a point that is `length` long, nearly inextensible.
analytic::ElasticCatenary chain(const Vector3& to, double length) {
  return analytic::elastic_catenary(to.x(), to.z(), length, 0.1 * gravity * length, 1e7);
}

TEST(Eyelet, TwoCatenariesOfEqualTension) {
  const Vector3 eye(0.6, 0, 0.1), end(1.4, 0, 0.3);
  constexpr double length = 2;
  // The length on the left side with which tensions are equal: there the energy is least, next to where the cable begins.
  double low = 0.62, high = 0.8;
  const auto tension_at_end = [](const analytic::ElasticCatenary& c) { return std::hypot(c.horizontal, c.vertical - c.weight); };
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    const auto left = chain(eye, middle), right = chain(end - eye, length - middle);
    // More on the left: it hangs lower, and pulls less.
    (tension_at_end(left) > std::hypot(right.horizontal, right.vertical) ? low : high) = middle;
  }
  const double exact = 0.5 * (low + high), tension = tension_at_end(chain(eye, exact));
  std::vector<Sample> tensions;
  const auto samples = sample({25, 50, 100}, [&](int n) {
    SceneDesc scene = scenes::one_cable(n, length);
    scene.cables[0].attachments = {scenes::attachment("left", PlaceDesc::At::start, Vector3::Zero()),
                                   scenes::attachment("right", PlaceDesc::At::end, end)};
    scene.cables[0].initial.type = InitialShapeDesc::Type::settled;
    scene.guides = {guide("eye", 0.8, eye)};
    Simulation run(scene);
    EXPECT_TRUE(run.world.findings().unsettled.empty());
    const GuideView view = run.world.view_guide(0);
    EXPECT_NEAR(view.tension[0], view.tension[1], 1e-6);
    tensions.push_back({static_cast<double>(n), std::abs(view.tension[0] / tension - 1)});
    const double flow = std::abs(run.world.guides()[0].flow);
    run.run(0.1);
    EXPECT_NEAR(run.world.view_guide(0).arc_length, view.arc_length, 1e-6) << flow;
    return std::abs(view.arc_length / exact - 1);
  });
  report("eyelet between two heights: arc length", samples, 1e-3, Order::none);
  report("eyelet between two heights: tension", tensions, 1e-3, Order::none);
}

/// A weightless rope to and fro between an upper and a lower row of eyelets, whose end is hauled.
TEST(Tackle, EveryTurnTakesItsShare) {
  constexpr double friction = 0.1, stretch = 0.03;
  for (const int turns : {2, 3, 4}) {
    SceneDesc scene = scenes::one_cable(20 * (turns + 1), (turns + 1) * std::hypot(1, 0.1));
    scene.gravity.acceleration.setZero();
    scene.materials[0].material.axial_stiffness = 1e3;
    scene.materials[0].material.axial_damping = 10;
    scene.materials[0].material.linear_density = 0.01;
    CableDesc& cable = scene.cables[0];
    cable.initial.type = InitialShapeDesc::Type::points;
    for (int i = 0; i <= turns + 1; ++i) cable.initial.points.push_back({0.1 * i, 0, i % 2 == 0 ? 0.0 : -1.0});
    const Vector3 end = cable.initial.points.back(), haul = (end - cable.initial.points[turns]).normalized();
    cable.attachments = {scenes::attachment("held", PlaceDesc::At::start, Vector3::Zero()),
                         scenes::attachment("hauled", PlaceDesc::At::end, Vector3::Zero(), "hand")};
    cable.attachments[1].initial_pose = InitialPose{end.x(), end.y(), end.z(), 0, 0, 0};
    for (int i = 1; i <= turns; ++i)
      scene.guides.push_back(guide("eye" + std::to_string(i), i * std::hypot(1, 0.1), cable.initial.points[i], friction));
    Simulation run(scene);
    constexpr int steps = 2000;
    double ratio = 0, load = 0, exact_load = 0;
    const double turn = M_PI - 2 * std::atan(0.1);
    for (int i = 1; i <= steps; ++i) {
      run.inputs[1].pose.position = end + stretch * i / steps * haul;
      run.step();
    }
    const double hauled = run.world.view_guide(turns - 1).tension[1];
    ratio = hauled / run.world.view_guide(0).tension[0];
    EXPECT_NEAR(ratio / std::exp(friction * turns * turn), 1, 5e-3) << turns;
    // On the lower eyelets, along z.
    for (int i = 1; i <= turns; i += 2) {
      load += run.force("eye" + std::to_string(i)).z();
      const double after = hauled * std::exp(-friction * turn * (turns - i));
      exact_load += (after + after * std::exp(-friction * turn)) / std::hypot(1, 0.1);
    }
    EXPECT_NEAR(load / exact_load, 1, 5e-3) << turns;
  }
}

TEST(Guides, SnapshotsGoOnAlike) {
  SceneDesc scene = two_loads(50, 2, 1, 1.3);
  scene.guides = {guide("eye", 1, Vector3::Zero(), 0.02)};
  Simulation run(scene);
  run.run(0.3);
  Simulation copy = run;
  run.run(0.3);
  copy.run(0.3);
  EXPECT_EQ(run.world.hash(), copy.world.hash());
  Simulation again(scene);
  again.run(0.6);
  EXPECT_EQ(run.world.hash(), again.world.hash());
}

TEST(Guides, EndsWithPayloadsStopAndFreeOnesRunOut) {
  SceneDesc scene = two_loads(40, 1, 0.05, 0.3);
  scene.guides = {guide("eye", 0.5, Vector3::Zero())};
  Simulation stopped(scene);
  stopped.run(1.5);
  ASSERT_EQ(stopped.world.view_guide(0).cable, 0);
  EXPECT_LT(stopped.world.view_guide(0).arc_length, 0.02);
  scene.cables[0].point_masses.erase(scene.cables[0].point_masses.begin());
  Simulation running(scene);
  int released = 0;
  for (int i = 0; i < 1000; ++i) {
    running.step();
    released += static_cast<int>(running.world.findings().released.size());
  }
  EXPECT_EQ(released, 1);
  EXPECT_EQ(running.world.view_guide(0).cable, -1);
}

TEST(Guides, OpenClipsTakeWhatComesClose) {
  SceneDesc scene = scenes::released(40, 0.6);
  GuideDesc clip = guide("clip", 0, {0, 0, -0.5});
  clip.place.reset();
  clip.type = GuideDesc::Type::clip;
  clip.capture = 0.01;
  scene.guides = {clip};
  Simulation run(scene);
  EXPECT_EQ(run.world.view_guide(0).cable, -1);
  int caught = 0;
  for (int i = 0; i < 1500; ++i) {
    run.step();
    caught += static_cast<int>(run.world.findings().caught.size());
  }
  EXPECT_EQ(caught, 1);
  EXPECT_NEAR(run.world.view_guide(0).arc_length, 0.5, 0.05);
}

TEST(Guides, WhatIsNotSimulatedIsRefused) {
  SceneDesc scene = two_loads(40, 2, 1, 1);
  scene.guides = {guide("eye", 1, Vector3::Zero()), guide("near", 1.01, {0.01, 0, 0})};
  EXPECT_THROW(World{scene}, SceneError);
  scene.guides.pop_back();
  EXPECT_NO_THROW(World{scene});
  scene.guides[0].type = GuideDesc::Type::sheave;
  scene.guides[0].radius = 0.05;
  scene.guides[0].inertia = 1e-3;
  scene.guides[0].friction = 0.5;
  EXPECT_THROW(World{scene}, SceneError);
}

}  // namespace
}  // namespace verlet_cable::validation

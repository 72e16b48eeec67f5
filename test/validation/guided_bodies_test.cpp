#include <cmath>

#include "bodies.h"

namespace verlet_cable::validation {
namespace {

GuideDesc& add_guide(SceneDesc& scene, const std::string& name, double at, const Vector3& offset) {
  GuideDesc& guide = scene.guides.emplace_back();
  guide.name = name;
  guide.cable = "rope";
  guide.place = PlaceDesc{PlaceDesc::At::arc_length, at};
  guide.offset = offset;
  return guide;
}

GuideDesc& add_sheave(SceneDesc& scene, const std::string& name, double at, const Vector3& offset, double radius) {
  GuideDesc& wheel = add_guide(scene, name, at, offset);
  wheel.type = GuideDesc::Type::sheave;
  wheel.rotation = {0.5 * M_PI, 0, 0};
  wheel.radius = radius;
  return wheel;
}

/// Two bodies on a rope over what is in the middle.
SceneDesc two_bodies(double m1, double m2, int segments) {
  SceneDesc scene = no_cables();
  scene.materials[0].material.linear_density = 0.01;
  for (const auto& [name, mass, x] : {std::tuple{"light", m1, -0.05}, {"heavy", m2, 0.05}})
    add_body(scene, name, mass, Vector3::Constant(1e-3), {x, 0, -1, 0, 0, 0});
  CableDesc& rope = add_cable(scene, "rope", 2 + 0.05 * M_PI, segments, {}, {}, {"light"}, {"heavy"});
  rope.initial.type = InitialShapeDesc::Type::automatic;
  return scene;
}

/// x'' = a + k^2 x from rest, as the rope's weight follows.
double way_of_atwood(double drive, double mass, double density, double time) {
  const double k = std::sqrt(2 * density * gravity / mass);
  return drive / mass / (k * k) * (std::cosh(k * time) - 1);
}

TEST(GuidedBodies, AtwoodsMachine) {
  constexpr double m1 = 1, m2 = 1.2, radius = 0.05, inertia = 1e-3, time = 0.4;
  const auto samples = sample({43, 86}, [&](int n) {
    SceneDesc scene = two_bodies(m1, m2, n);
    add_sheave(scene, "wheel", 0.5 * scene.cables[0].length, Vector3::Zero(), radius).inertia = inertia;
    Simulation run(scene);
    const double start = run.world.bodies()[1].pose.position.z(), energy = run.world.energy().total();
    run.run(time);
    const double mass = m1 + m2 + 0.01 * scene.cables[0].length + inertia / (radius * radius);
    const double way = way_of_atwood((m2 - m1) * gravity, mass, 0.01, time);
    EXPECT_NEAR(run.world.energy().total(), energy, 1e-5 * run.world.energy().kinetic);
    return std::abs((start - run.world.bodies()[1].pose.position.z()) / way - 1);
  });
  report("Atwood's machine of bodies, wheel with inertia", samples, 2e-3, Order::none);
}

/// A load hangs in a bight of the rope, from the ceiling and a hand.
SceneDesc hanging_in_a_bight(bool on_wheel) {
  constexpr double mass = 2;
  SceneDesc scene = no_cables();
  scene.materials[0].material.linear_density = 1e-3;
  add_body(scene, "load", mass, Vector3::Constant(1e-3), {0, 0, -1.03, 0, 0, 0});
  CableDesc& rope = add_cable(scene, "rope", 2.05, 50, {}, {}, {"", {-0.05, 0, 0}}, {""});
  rope.attachments[1].frame = "hand";
  rope.attachments[1].initial_pose = InitialPose{0.05, 0, 0, 0, 0, 0};
  rope.initial.type = InitialShapeDesc::Type::settled;
  if (on_wheel)
    add_sheave(scene, "eye", 1.025, {0, 0, 0.05}, 0.05).body = "load";
  else
    add_guide(scene, "eye", 1.025, {0, 0, 0.05}).body = "load";
  return scene;
}

TEST(GuidedBodies, MovingBlockHalvesForceAndWay) {
  constexpr double haul = 0.4;
  for (const bool on_wheel : {false, true}) {
    Simulation run(hanging_in_a_bight(on_wheel));
    ASSERT_TRUE(run.world.findings().unsettled.empty());
    const double start = run.world.bodies()[0].pose.position.z();
    const double weight = 2 * gravity + 1e-3 * 2.05 * gravity;
    for (const char* name : {"rope_start", "rope_end"}) EXPECT_NEAR(run.force(name).z(), -0.5 * weight, 1e-4 * weight) << name;
    constexpr int steps = 1500;
    for (int i = 1; i <= steps; ++i) {
      const double part = static_cast<double>(i) / steps;
      run.inputs[1].pose.position = {0.05, 0, haul * part * part * (3 - 2 * part)};
      run.step();
    }
    run.run(0.2);
    EXPECT_NEAR(run.world.bodies()[0].pose.position.z() - start, 0.5 * haul, 2e-3) << on_wheel;
    const GuideView view = run.world.view_guide(0);
    EXPECT_NEAR(view.tension[0] / view.tension[1], 1, 1e-3);
  }
}

/// Two phalanges that hang from a palm, with a rope in front of both joints, through eyelets on the first one and to the second
/// one: as it is drawn the weights are lifted until its tension is in equilibrium with them about both axles.
TEST(GuidedBodies, FingerIsBentByItsRope) {
  constexpr double length = 0.06, radius = 0.008, mass = 0.03, pull = 0.02;
  SceneDesc scene = no_cables();
  scene.materials[0].material.linear_density = 2e-3;
  scene.materials[0].material.radius = 5e-4;
  // It hangs down from a palm at the origin; axles along y, centers of mass in the middle.
  for (const int k : {0, 1}) {
    BodyDesc& phalanx = add_body(scene, k == 0 ? "proximal" : "distal", mass, {1e-5, 1e-5, 2e-6}, {0, 0, -length * k, 0, 0, 0});
    phalanx.center_of_mass = Vector3(0, 0, -0.5 * length);
    phalanx.angular_damping = 2e-4;
    BodyAttachmentDesc& axle = hold(phalanx, AttachmentType::axle, Vector3::Zero(), k == 0 ? "" : "proximal",
                                    k == 0 ? Vector3::Zero() : Vector3(0, 0, -length));
    axle.at = {0, 0, 0, 0.5 * M_PI, 0, 0};
    axle.rotation = {0.5 * M_PI, 0, 0};
  }
  // The rope comes from above, in front of both axles, and ends on the distal phalanx.
  const double up = 0.1, end = 0.75 * length;
  CableDesc& rope = add_cable(scene, "rope", up + length + end, 60, {radius, 0, up}, {radius, 0, -length - end}, {""},
                              {"distal", {radius, 0, -end}});
  rope.attachments[0].frame = "hand";
  rope.attachments[0].offset.setZero();
  rope.attachments[0].initial_pose = InitialPose{radius, 0, up, 0, 0, 0};
  add_guide(scene, "upper", up + 0.25 * length, {radius, 0, -0.25 * length}).body = "proximal";
  add_guide(scene, "lower", up + 0.75 * length, {radius, 0, -0.75 * length}).body = "proximal";
  Simulation run(scene);
  constexpr int steps = 2000;
  for (int i = 1; i <= steps; ++i) {
    const double part = std::min(1.0, 2.0 * i / steps);
    run.inputs[1].pose.position.z() = up + pull * part * part * (3 - 2 * part);
    run.step();
  }
  const auto angle = [&](int body) {
    const Vector3 down = -(run.world.bodies()[body].pose.orientation * Vector3::UnitZ());
    return std::atan2(down.x(), -down.z());
  };
  EXPECT_GT(angle(1) - angle(0), 0.05);
  // The way of the rope is what the joints have taken: of the polygon through the guides.
  const auto place = [&](const char* body, double z) {
    const Pose& pose = body_of(run, body).pose;
    return Vector3(pose.position + pose.orientation * Vector3(radius, 0, z));
  };
  const Vector3 hand = run.inputs[1].pose.position, upper = place("proximal", -0.25 * length),
                lower = place("proximal", -0.75 * length), tip = place("distal", -end);
  EXPECT_NEAR((hand - upper).norm() + (upper - lower).norm() + (lower - tip).norm(), rope.length, 1e-6);
  const double tension = run.world.view_guide(1).tension[1];
  EXPECT_NEAR(run.world.view_guide(0).tension[0], tension, 0.01 * tension);
  const double half = 0.5 * mass * gravity * length, lower_weight = half * std::sin(angle(1));
  const Vector3 joint = body_of(run, "distal").pose.position;
  EXPECT_NEAR((tip - joint).cross(tension * (lower - tip).normalized()).y(), -lower_weight, 0.03 * half);
  EXPECT_NEAR(upper.cross(tension * (hand - upper).normalized()).y(), -lower_weight - 3 * half * std::sin(angle(0)), 0.03 * half);
}

}  // namespace
}  // namespace verlet_cable::validation

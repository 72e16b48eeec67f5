#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "../support/scenes.h"
#include "../support/world_inspector.h"
#include "law/sliding_spring.h"
#include "world/state_fields.h"

// Bending that stays, and friction between strands, against closed forms: beyond its yield curvature k_y a wire is bent with the
// moment EI ((1 - h) k_y + h k), h its hardening; unloaded from k it keeps the curvature (1 - h) (k - k_y); bent to and fro
// between -k and k it loses 4 (1 - h) EI k_y (k - k_y) a round and metre (kinematic hardening), and to friction of the moment m,
// which slips after k_s = m / (10 EI), 4 m (k - k_s) (Masing).

namespace verlet_cable {
namespace {

using At = PlaceDesc::At;
using Status = StepResult::Status;

constexpr double stiffness = 0.02;  // [N m^2]
constexpr double sticking = 10;     // of strands that do not slip, over that

/// Of what bends to `curvature` for the first time [N m], and what it loses a metre between that and its opposite [J/m].
double moment_at(double curvature, const MaterialDesc& m) {
  const double yield = std::min(m.yield_curvature, curvature);
  return stiffness * ((1 - m.hardening) * yield + m.hardening * curvature) + m.bending_friction;
}
double loop_between(double curvature, const MaterialDesc& m) {
  const double yield = std::min(m.yield_curvature, curvature);
  return 4 * (1 - m.hardening) * stiffness * yield * (curvature - yield) +
         4 * m.bending_friction * (curvature - m.bending_friction / (sticking * stiffness));
}

TEST(SlidingSpring, SlidesToTheNearestPlaceByItsEnergy) {
  const SlidingSpring spring{3, 0.2, 0.1, {}};
  for (int i = 0; i < 60; ++i) {
    const AboutAxes strain{0.4 * std::sin(1.0 + i), 0.7 * std::cos(2.0 * i)};
    const AboutAxes slid = spring.slide(strain).strain;
    const double size = std::sqrt(dot(strain, strain));
    if (size <= spring.limit) {
      EXPECT_EQ(slid.y, strain.y);
      continue;
    }
    EXPECT_NEAR(std::sqrt(dot(slid, slid)), spring.limit, 1e-15);
    const double least = spring.energy(strain - slid);
    for (int k = 0; k < 360; ++k) {
      const AboutAxes other{0.1 * std::cos(k * M_PI / 180), 0.1 * std::sin(k * M_PI / 180)};
      EXPECT_GE(spring.energy(strain - other), least * (1 - 1e-12)) << i << " " << k;
    }
  }
}

TEST(SlidingSpring, DerivativeIsThatOfItsMoment) {
  for (const SlidingSpring& spring : {SlidingSpring{3, 3, 0.1, {}}, SlidingSpring{3, 0.2, 0.1, {}}})
    for (int i = 0; i < 20; ++i) {
      const AboutAxes strain{0.4 * std::sin(1.0 + i), 0.7 * std::cos(2.0 * i)};
      const Slide slide = spring.slide(strain);
      constexpr double h = 1e-6;
      const auto moment = [&](double y, double z) { return spring.moment(spring.slide(strain + AboutAxes{y, z}).strain); };
      const AboutAxes by_y = (0.5 / h) * (moment(h, 0) - moment(-h, 0)), by_z = (0.5 / h) * (moment(0, h) - moment(0, -h));
      EXPECT_NEAR(by_y.y, slide.yy, 1e-7);
      EXPECT_NEAR(by_y.z, slide.yz, 1e-7);
      EXPECT_NEAR(by_z.y, slide.yz, 1e-7);
      EXPECT_NEAR(by_z.z, slide.zz, 1e-7);
    }
}

TEST(SlidingSpring, LosesEnergyHoweverItIsBent) {
  const SlidingSpring start{3, 0.2, 0.1, {}};
  SlidingSpring spring = start;
  AboutAxes bend;
  for (int i = 0; i < 1000; ++i) {
    const AboutAxes before = bend - spring.slid, change{0.3 * std::sin(1.7 * i), 0.2 * std::cos(2.3 * i * i)};
    bend = bend + change;
    const AboutAxes tried = bend - spring.slid, after = spring.slide(tried).strain, slid = tried - after;
    const AboutAxes moment = spring.moment(0.5 * (before + after));
    const double loss = dot(moment, slid);
    ASSERT_GE(loss, -1e-18);
    EXPECT_NEAR(dot(moment, change), spring.energy(after) - spring.energy(before) + loss, 1e-16);
    spring.slid = spring.slid + slid;
  }
}

/// However small its limit is, it slides to that, and no number underflows.
TEST(SlidingSpring, HasTheSmallestOfLimits) {
  for (const double limit : {1e-300, 1e-200, 1e-160, 1e-100, 1e-20})
    for (const SlidingSpring& spring : {SlidingSpring{3, 3, limit, {}}, SlidingSpring{3, 0.2, limit, {}}})
      for (const AboutAxes& strain : {AboutAxes{0.3, -0.4}, AboutAxes{-1e-9, 0}}) {
        const Slide slide = spring.slide(strain);
        EXPECT_NEAR(std::hypot(slide.strain.y, slide.strain.z) / limit, 1, 1e-14) << limit;
        for (const double slope : {slide.yy, slide.zz}) {
          const double most = 3 * limit / std::sqrt(dot(strain, strain));
          EXPECT_GE(slope, -1e-12 * most) << limit;
          EXPECT_LE(slope, (1 + 1e-12) * most) << limit;
        }
      }
}

constexpr int segments = 20;

/// A wire of a metre without weight, straight along x, clamped at the origin and in the frame "hand" at its end.
SceneDesc wire() {
  SceneDesc scene = scenes::held_by_a_hand(segments, AttachmentType::clamp);
  scene.gravity.acceleration.setZero();
  scene.time_step = 0.005;
  MaterialDesc& material = scene.materials[0].material;
  material.linear_density = 0.01;
  material.bending_stiffness = stiffness;
  material.bending_damping = 1e-4;
  material.drag = 0.005;
  scene.cables[0].attachments[1].initial_pose = InitialPose{1, 0, 0, 0, 0, 0};
  scene.cables[0].initial.type = InitialShapeDesc::Type::straight;
  return scene;
}

/// The end of a polygon from the origin along x whose corners bend alike, and half as much at its clamped ends.
Pose end_of_arc(double curvature, double length, int count, const Vector3& axis) {
  const double segment = length / count;
  Pose end;
  for (int i = 0; i < count; ++i)
    end.position += segment * (Eigen::AngleAxisd(curvature * segment * (i + 0.5), axis) * Vector3::UnitX());
  end.orientation = Quaternion(Eigen::AngleAxisd(curvature * length, axis));
  return end;
}

/// Where the hand bends the wire so, with one moment.
BoundaryInputs bent(double curvature, const Vector3& axis = Vector3::UnitZ()) {
  BoundaryInputs inputs(2);
  inputs[1].pose = end_of_arc(curvature, 1, segments, axis);
  return inputs;
}

double yielded(const World& world) {
  return world.ledger().balance.dissipated.yielding;
}

double energy(const World& world) {
  return world.energy().total();
}

/// Bends it from one curvature to another, slower where it begins and ends; `reached` is called with each step's.
void bend_it(double from, double to, int steps, World& world, const std::function<void(double)>& reached = {},
             const Vector3& axis = Vector3::UnitZ()) {
  for (int i = 1; i <= steps; ++i) {
    const double curvature = from + (to - from) * 0.5 * (1 - std::cos(M_PI * i / steps)), before = yielded(world);
    ASSERT_EQ(world.step(bent(curvature, axis)).status, Status::ok) << i;
    ASSERT_GE(yielded(world), before - 1e-15) << i;
    if (reached) reached(curvature);
  }
}

struct Law {
  const char* name;
  double yield_curvature, hardening, friction;
};

class Yielding : public testing::TestWithParam<std::tuple<Law, double>> {};

/// With and without a torsional stiffness: what has none is as straight about itself as it was.
TEST_P(Yielding, HasTheMomentSpringbackAndLoopOfClosedForms) {
  const auto& [law, torsional_stiffness] = GetParam();
  SceneDesc scene = wire();
  MaterialDesc& material = scene.materials[0].material;
  material.torsional_stiffness = torsional_stiffness;
  material.yield_curvature = law.yield_curvature;
  material.hardening = law.hardening;
  material.bending_friction = law.friction;
  World world(scene, initial_frames(scene));
  constexpr double most = 3;
  const auto torque = [&] { return -world.attachments()[0].torque.z(); };
  bend_it(0, most, 1500, world);
  EXPECT_NEAR(std::abs(torque()), moment_at(most, material), 2e-3 * moment_at(most, material));

  // A round, measured at the clamp at rest.
  const double before = yielded(world);
  double area = 0, last_torque = std::abs(torque()), last = most;
  const double sign = torque() > 0 ? 1 : -1;
  const auto add = [&](double curvature) {
    const double now = sign * torque();
    area += 0.5 * (now + last_torque) * (curvature - last);
    last_torque = now;
    last = curvature;
  };
  bend_it(most, -most, 3000, world, add);
  bend_it(-most, most, 3000, world, add);
  const double loop = loop_between(most, material);
  EXPECT_NEAR(yielded(world) - before, loop, 2e-3 * loop);
  // The damping of bending has a part in it.
  EXPECT_NEAR(area, loop, 5e-3 * loop);

  EXPECT_EQ(world.ledger().unaccounted_steps, 0);
  if (law.yield_curvature == infinity) {
    EXPECT_TRUE(plastic_curvature(world.cables()[0]).empty());
  } else if (law.friction == 0) {
    // Bent back until it has no moment, it stays there when it is let go.
    const double kept = (1 - law.hardening) * (most - law.yield_curvature);
    bend_it(most, kept, 1500, world);
    EXPECT_NEAR(torque(), 0, 2e-3 * moment_at(most, material));
    ASSERT_TRUE(world.apply(edit::Unpin{"grip"}).ok);
    for (int i = 0; i < 500; ++i) ASSERT_EQ(world.step(bent(kept)).status, Status::ok);
    const std::vector<double> curvature = node_curvature(world.cables()[0].state), plastic = plastic_curvature(world.cables()[0]);
    ASSERT_EQ(plastic.size(), segments - 1u);
    for (int i = 0; i + 1 < segments; ++i) {
      EXPECT_NEAR(curvature[i], kept, 2e-3 * kept) << i;
      EXPECT_NEAR(plastic[i], kept, 2e-3 * kept) << i;
    }
  }
  EXPECT_NEAR(world.ledger().unaccounted(), 0, 1e-4 * loop);
}

INSTANTIATE_TEST_SUITE_P(Laws, Yielding,
                         testing::Combine(testing::Values(Law{"hardening", 1, 0.2, 0}, Law{"nearlyIdeal", 1, 0.02, 0},
                                                          Law{"friction", infinity, 0, 0.01}, Law{"both", 1.5, 0.1, 0.005}),
                                          testing::Values(0.0, 0.015)),
                         [](const auto& info) {
                           return std::string(std::get<0>(info.param).name) +
                                  (std::get<1>(info.param) > 0 ? "" : "WithoutTorsion");
                         });

/// Beyond h (k - k_y) = k_y it yields back as it is let go, and keeps k_y (1 - h) / h.
TEST(YieldingRod, YieldsBackWhereItWasBentFar) {
  SceneDesc scene = wire();
  MaterialDesc& material = scene.materials[0].material;
  material.yield_curvature = 0.5;
  material.hardening = 0.25;
  World world(scene, initial_frames(scene));
  constexpr double kept = 0.5 * 0.75 / 0.25;
  bend_it(0, 4, 2000, world);
  EXPECT_GT((1 - 0.25) * (4 - 0.5), 1.5 * kept);
  bend_it(4, kept, 2000, world);
  EXPECT_NEAR(world.attachments()[0].torque.z(), 0, 2e-3 * moment_at(4, material));
  const double loss = 0.75 * stiffness * 0.5 * ((4 - 0.5) + (4 - kept - 2 * 0.5));
  EXPECT_NEAR(yielded(world), loss, 5e-3 * loss);
}

/// Two bending stiffnesses: the yield curvature is that of any direction, the moment about each axis that of its stiffness.
TEST(YieldingRod, BendsAboutEachOfItsAxes) {
  for (const Vector3& axis : {Vector3(Vector3::UnitY()), Vector3(Vector3::UnitZ())}) {
    SceneDesc scene = wire();
    MaterialDesc& material = scene.materials[0].material;
    material.bending_stiffness = {0.06, 0.02};
    material.torsional_stiffness = 0.03;
    material.yield_curvature = 1;
    material.hardening = 0.2;
    World world(scene, initial_frames(scene));
    bend_it(0, 2.5, 2000, world, {}, axis);
    const double of_axis = axis.y() != 0 ? 0.06 : 0.02, moment = of_axis * (0.8 + 0.2 * 2.5);
    EXPECT_NEAR(std::abs(world.attachments()[0].torque.dot(axis)), moment, 2e-3 * moment);
    EXPECT_NEAR(yielded(world), 0.8 * of_axis * 1.5, 2e-3 * 0.8 * of_axis * 1.5);
    EXPECT_EQ(world.ledger().unaccounted_steps, 0);
  }
}

/// Swung about in all directions, with gravity: energy goes, and none of it comes from nowhere.
TEST(YieldingRod, OnlyLosesEnergy) {
  for (const BendingStiffness& bending : {BendingStiffness(0.02), BendingStiffness(0.02, 0.005)}) {
    SceneDesc scene = scenes::one_cable(16);
    MaterialDesc& material = scene.materials[0].material;
    material.bending_stiffness = bending;
    material.torsional_stiffness = 0.01;
    material.yield_curvature = 1.5;
    material.hardening = 0.1;
    material.bending_friction = 2e-4;
    scene.tolerance = 1e-6;
    CableDesc& cable = scene.cables[0];
    cable.attachments = {scenes::attachment("start", At::start, {0, 0, 0}, "", AttachmentType::clamp)};
    cable.initial.type = InitialShapeDesc::Type::straight;
    cable.initial.to = {1, 0, 0};
    World world(scene, BoundaryInputs(1));
    const double scale = 0.1 * 9.81;
    double before = energy(world);
    for (int i = 0; i < 3000; ++i) {
      const double yielded_before = yielded(world);
      ASSERT_EQ(world.step(BoundaryInputs(1)).status, Status::ok) << i;
      ASSERT_LT(energy(world), before + 1e-7 * scale) << i;
      ASSERT_GE(yielded(world), yielded_before - 1e-15) << i;
      before = energy(world);
    }
    EXPECT_GT(yielded(world), 0.05 * scale);
    EXPECT_EQ(world.ledger().unaccounted_steps, 0);
    EXPECT_NEAR(world.ledger().unaccounted(), 0, 1e-5 * scale);
  }
}

constexpr double mandrel_radius = 0.1, mandrel_yield_curvature = 4, mandrel_hardening = 0.05;

/// A straight wire that begins on a mandrel about z, in a vice, and that pliers hold at its end.
SceneDesc wire_on_a_mandrel(int count, double length, double wire_radius) {
  const double way = mandrel_radius + wire_radius;
  SceneDesc scene = scenes::one_cable(count, length);
  scene.gravity.acceleration.setZero();
  MaterialDesc& material = scene.materials[0].material;
  material.linear_density = 0.03;
  material.radius = wire_radius;
  material.bending_stiffness = 0.05;
  material.torsional_stiffness = 0.04;
  material.drag = 0.005;
  material.yield_curvature = mandrel_yield_curvature;
  material.hardening = mandrel_hardening;
  ObstacleDesc mandrel;
  mandrel.name = "mandrel";
  mandrel.type = ShapeType::cylinder;
  mandrel.radius = mandrel_radius;
  mandrel.length = 0.3;
  scene.obstacles = {mandrel};
  CableDesc& cable = scene.cables[0];
  cable.initial.type = InitialShapeDesc::Type::straight;
  cable.initial.from = {0, way, 0};
  cable.initial.to = {1, way, 0};
  cable.attachments = {scenes::attachment("vice", At::start, {0, way, 0}, "", AttachmentType::clamp),
                       scenes::attachment("pliers", At::end, {0, 0, 0}, "hand")};
  cable.attachments[1].initial_pose = InitialPose{length, way, 0, 0, 0, 0};
  return scene;
}

/// [1/m] What a wire keeps that lay on the mandrel.
double kept_of_mandrel(double way) {
  return (1 - mandrel_hardening) * (1 / way - mandrel_yield_curvature);
}

/// A wire that is laid round a mandrel by its clamped end and let go has the radius of its springback.
TEST(YieldingWire, BentRoundAMandrelHasTheRadiusOfItsSpringback) {
  constexpr double wire_radius = 0.001, way = mandrel_radius + wire_radius, length = 0.3;
  constexpr int count = 30;
  SceneDesc scene = wire_on_a_mandrel(count, length, wire_radius);
  scene.materials[0].material.bending_damping = 1e-4;
  scene.cables[0].attachments[1].type = AttachmentType::clamp;
  World world(scene, initial_frames(scene));
  BoundaryInputs inputs(2);
  const double kept = kept_of_mandrel(way);
  bool touched = false;
  const auto bend_to = [&](double from, double to) {
    for (int i = 0; i <= 4000; ++i) {
      const Pose end = end_of_arc(from + (to - from) * (0.5 - 0.5 * std::cos(M_PI * i / 4000)), length, count, -Vector3::UnitZ());
      inputs[1].pose = {end.position + Vector3(0, way, 0), end.orientation};
      ASSERT_EQ(world.step(inputs).status, Status::ok) << i;
      touched = touched || world.contact_wrench("mandrel").force.norm() > 0;
    }
  };
  bend_to(0, 1.001 / way);
  EXPECT_TRUE(touched);
  bend_to(1.001 / way, kept);
  // The first step begins with a hand that moves at once.
  EXPECT_LE(world.ledger().unaccounted_steps, 1);
  ASSERT_TRUE(world.apply(edit::Unpin{"pliers"}).ok);
  for (int i = 0; i < 1000; ++i) ASSERT_EQ(world.step(inputs).status, Status::ok) << i;
  double sum = 0;
  for (const double curvature : node_curvature(world.cables()[0].state)) sum += curvature / (count - 1);
  EXPECT_NEAR(1 / sum, 1 / kept, 0.01 / kept);
}

/// What a wire keeps of the curvature of a mandrel round which it has been drawn by its end, over what a wire of infinitely many
/// segments keeps. Its end goes along the involute, a little short of it.
double kept_of_winding(int count) {
  constexpr double wire_radius = 2e-4, way = mandrel_radius + wire_radius, length = 0.6, wound = 3.6, slack = 0.002;
  constexpr int steps = 4000;
  SceneDesc scene = wire_on_a_mandrel(count, length, wire_radius);
  scene.time_step = 0.002;
  scene.materials[0].material.bending_damping = 1e-6;
  scene.materials[0].material.friction = 0;
  World world(scene, initial_frames(scene));
  BoundaryInputs inputs = initial_frames(scene);
  double before = 0;
  for (int i = 1; i <= steps; ++i) {
    const double u = static_cast<double>(i) / steps, angle = wound * (u - std::sin(2 * M_PI * u) / (2 * M_PI));
    const double free_length = length - way * angle - slack;
    const double sine = std::sin(angle), cosine = std::cos(angle);
    inputs[1].pose.position = Vector3(way * sine + free_length * cosine, way * cosine - free_length * sine, 0);
    EXPECT_EQ(world.step(inputs).status, Status::ok) << i;
    EXPECT_GE(yielded(world), before - 1e-15) << i;
    before = yielded(world);
  }
  double sum = 0;
  int nodes = 0;
  const std::vector<double> plastic = plastic_curvature(world.cables()[0]);
  for (int i = 1; i < count; ++i) {
    const double place = length * i / count;
    if (place < 0.08 || place > way * wound - 0.1) continue;
    sum += plastic[i - 1];
    ++nodes;
  }
  return sum / nodes / kept_of_mandrel(way);
}

/// While the place where a wire comes to lie on a mandrel passes along a segment, the node behind it is bent further than the
/// mandrel: by an error of first order in the length of segments, and nothing of the law's.
TEST(YieldingWire, DrawnRoundAMandrelKeepsItsCurvatureByTheLengthOfItsSegments) {
  const double coarse = kept_of_winding(30) - 1, medium = kept_of_winding(60) - 1, fine = kept_of_winding(120) - 1;
  EXPECT_LT(coarse, 0.08);
  EXPECT_LT(medium, 0.7 * coarse);
  EXPECT_LT(fine, 0.6 * medium);
  EXPECT_LT(fine, 0.025);
  EXPECT_GT(fine, 0);
}

/// A plug on the end of a wire that yields: it hangs lower than on one that does not, at once as it would after long.
TEST(YieldingWire, CarriesABody) {
  for (const bool yields : {false, true}) {
    SceneDesc scene = scenes::one_cable(12, 0.3);
    MaterialDesc& material = scene.materials[0].material;
    material.linear_density = 0.02;
    material.bending_stiffness = 0.02;
    material.torsional_stiffness = 0.015;
    material.bending_damping = 5e-4;
    if (yields) {
      material.yield_curvature = 1;
      material.hardening = 0.3;
      material.bending_friction = 1e-4;
    }
    CableDesc& cable = scene.cables[0];
    cable.initial.type = InitialShapeDesc::Type::straight;
    cable.initial.to = {1, 0, 0};
    cable.attachments = {scenes::attachment("wall", At::start, {0, 0, 0}, "", AttachmentType::clamp),
                         scenes::attachment("in_plug", At::end, {0, 0, 0}, "", AttachmentType::clamp)};
    cable.attachments[1].body = "plug";
    BodyDesc& plug = scene.bodies.emplace_back();
    plug.name = "plug";
    plug.mass = 0.02;
    plug.inertia = {1e-5, 1e-5, 1e-5};
    World world(scene, initial_frames(scene));
    double before = energy(world);
    for (int i = 0; i < 3000; ++i) {
      const double yielded_before = yielded(world);
      ASSERT_EQ(world.step(initial_frames(scene)).status, Status::ok) << i;
      ASSERT_GE(yielded(world), yielded_before - 1e-15) << i;
      ASSERT_LT(energy(world), before + 1e-7) << i;
      before = energy(world);
    }
    EXPECT_EQ(world.ledger().unaccounted_steps, 0) << yields;
    if (yields)
      EXPECT_GT(yielded(world), 1e-4);
    else
      EXPECT_EQ(yielded(world), 0);
  }
}

SceneDesc yielding_wire() {
  SceneDesc scene = wire();
  MaterialDesc& material = scene.materials[0].material;
  material.yield_curvature = 1;
  material.hardening = 0.1;
  material.bending_friction = 0.002;
  return scene;
}

TEST(YieldingState, IsHashedCopiedAndSaved) {
  const SceneDesc scene = yielding_wire();
  World world(scene, initial_frames(scene));
  bend_it(0, 3, 300, world);
  State& state = WorldInspector::state(world);
  ASSERT_EQ(state.cables[0].state.bending_memory.size(), static_cast<std::size_t>(segments));
  const std::uint64_t before = hash(state);
  for (auto* number :
       {&state.cables[0].state.bending_memory[3][1].yielded[1], &state.cables[0].state.bending_memory[7][0].slipped[0]}) {
    const double kept = *number;
    *number += 1e-12;
    EXPECT_NE(hash(state), before);
    *number = kept;
  }
  World copy = world;
  World restored(world.scene());
  restored.restore(world.save());
  for (World* other : {&world, &copy, &restored}) bend_it(3, 0.5, 200, *other);
  EXPECT_EQ(copy.hash(), world.hash());
  EXPECT_EQ(restored.hash(), world.hash());
}

/// What was bent stays bent through a cut, a turn and a join, and through a clamp in the middle.
TEST(YieldingState, GoesWithTheMaterialThroughEdits) {
  const SceneDesc scene = yielding_wire();
  World world(scene, initial_frames(scene));
  bend_it(0, 3, 1000, world);
  const std::vector<double> before = plastic_curvature(world.cables()[0]);
  ASSERT_GT(*std::min_element(before.begin(), before.end()), 1);
  ASSERT_TRUE(world.apply(edit::Cut{cable_id(0), 12}).ok);
  ASSERT_EQ(world.cables().size(), 2u);
  const std::vector<double> first = plastic_curvature(world.cables()[0]), second = plastic_curvature(world.cables()[1]);
  // The segment that is cut is gone.
  ASSERT_EQ(first.size() + second.size(), before.size() - 2);
  for (int i = 0; i < 11; ++i) EXPECT_EQ(first[i], before[i]) << i;
  for (int i = 0; i < 6; ++i) EXPECT_EQ(second[i], before[13 + i]) << i;
  // Each of the two ends brings its half of a bend along.
  ASSERT_TRUE(world.apply(edit::Join{0, true, 1, false}).ok);
  for (int i = 0; i < 4000; ++i) ASSERT_EQ(world.step(bent(3)).status, Status::ok) << i;
  ASSERT_EQ(world.cables().size(), 1u);
  const std::vector<double> joined = plastic_curvature(world.cables()[0]);
  ASSERT_EQ(joined.size(), before.size() - 1);
  EXPECT_GT(joined[11], 0.5 * before[11]);
}

/// A shape that is given at once is as if it had been bent to it; one that was given before, too.
TEST(YieldingState, YieldsToShapesThatItIsGiven) {
  SceneDesc scene = yielding_wire();
  scene.materials[0].material.bending_friction = 0;
  World world(scene, initial_frames(scene));
  bend_it(0, 3, 1500, world);
  World given(scene, initial_frames(scene));
  given.step(bent(3));
  SceneDesc at_once = scene;
  at_once.cables[0].initial.type = InitialShapeDesc::Type::points;
  at_once.cables[0].initial.points = world.cables()[0].state.positions;
  const Pose& hand = bent(3)[1].pose;
  at_once.cables[0].attachments[1].initial_pose = InitialPose{hand.position.x(), hand.position.y(), 0, 0, 0, 3};
  World started(at_once, initial_frames(at_once));
  const std::vector<double> bent_to = plastic_curvature(world.cables()[0]), of_start = plastic_curvature(started.cables()[0]);
  for (std::size_t i = 0; i < bent_to.size(); ++i) EXPECT_NEAR(of_start[i], bent_to[i], 0.01 * bent_to[i]) << i;
}

/// Settling is one bend, whatever way its iterations take: as far as the moment wants it.
TEST(YieldingState, SettlesAsFarAsItsMomentBendsIt) {
  SceneDesc scene = scenes::one_cable(40);
  MaterialDesc& material = scene.materials[0].material;
  material.linear_density = 0.05;
  material.bending_stiffness = 0.05;
  material.torsional_stiffness = 0.04;
  material.yield_curvature = 1;
  material.hardening = 0.3;
  CableDesc& cable = scene.cables[0];
  cable.attachments = {scenes::attachment("start", At::start, {0, 0, 0}, "", AttachmentType::clamp)};
  cable.initial.type = InitialShapeDesc::Type::settled;
  World world(scene, BoundaryInputs(1));
  const CableState& state = world.cables()[0].state;
  const std::vector<double> curvature = node_curvature(state), plastic = plastic_curvature(world.cables()[0]);
  for (int i = 1; i < 40; ++i) {
    double moment = 0;  // of the weight of what is beyond
    for (int k = i + 1; k <= 40; ++k) moment += state.masses[k] * 9.81 * (state.positions[k].x() - state.positions[i].x());
    const double bend = moment / 0.05, expected = bend <= 1 ? bend : 1 + (bend - 1) / 0.3;
    EXPECT_NEAR(curvature[i - 1], expected, 1e-3 * expected + 1e-5) << i;
    EXPECT_NEAR(plastic[i - 1], curvature[i - 1] - bend, 2e-3 * expected + 1e-5) << i;
  }
  ASSERT_GT(plastic[0], 0.1);
  for (int i = 0; i < 500; ++i) ASSERT_EQ(world.step(BoundaryInputs(1)).status, Status::ok);
  EXPECT_NEAR(world.energy().kinetic, 0, 1e-9);
  EXPECT_NEAR(yielded(world), 0, 1e-7);
}

/// What comes out of a winch remembers nothing, what it takes in is forgotten.
TEST(YieldingState, IsLeftAtAWinch) {
  for (const bool at_end : {false, true}) {
    SceneDesc scene = yielding_wire();
    World world(scene, initial_frames(scene));
    bend_it(0, 3, 1000, world);
    bend_it(3, 0, 1000, world);
    ASSERT_TRUE(world.apply(edit::Unpin{at_end ? "base" : "grip"}).ok);
    for (int i = 0; i < 1000; ++i) ASSERT_EQ(world.step(bent(0)).status, Status::ok);
    ASSERT_TRUE(world.apply(edit::SetLength{0, at_end, 0.5, 0.5}).ok);
    for (int i = 0; i < 2500; ++i) ASSERT_NE(world.step(bent(0)).status, Status::fault);
    ASSERT_TRUE(world.apply(edit::SetLength{0, at_end, 0.9, 0.5}).ok);
    for (int i = 0; i < 2500; ++i) ASSERT_NE(world.step(bent(0)).status, Status::fault);
    const std::vector<double> plastic = plastic_curvature(world.cables()[0]);
    const int near = at_end ? static_cast<int>(plastic.size()) - 3 : 2, far = at_end ? 2 : static_cast<int>(plastic.size()) - 3;
    EXPECT_LT(plastic[near], 0.02) << at_end;
    EXPECT_GT(plastic[far], 0.05) << at_end;
    EXPECT_NEAR(world.ledger().unaccounted(), 0, 1e-4) << at_end;
  }
}

/// A winch gives nodes out, and takes them in, beside a clamp that turns out of the plane in which the cable hangs. What resists
/// no twist turns in its clamps as it likes, and brings none of that into the cable.
TEST(YieldingState, IsHandedOverAtAWinchBesideATurnedClamp) {
  for (const bool at_end : {false, true})
    for (const bool rubs : {false, true})
      for (const double length : {0.5, 0.3}) {
        SceneDesc scene = scenes::one_cable(40, 0.4);
        MaterialDesc& material = scene.materials[0].material;
        material.linear_density = 0.1;
        material.bending_stiffness = 0.02;
        material.bending_damping = 1e-4;
        (rubs ? material.bending_friction : material.yield_curvature) = rubs ? 0.01 : 15;
        material.hardening = 0.1;
        CableDesc& cable = scene.cables[0];
        cable.attachments = {scenes::attachment("start", At::start, {0, 0, 0}, at_end ? "hand" : "", AttachmentType::clamp),
                             scenes::attachment("end", At::end, {0.24, 0, 0}, at_end ? "" : "hand", AttachmentType::clamp)};
        const Vector3 place = cable.attachments[at_end ? 0 : 1].offset;
        for (auto& attachment : cable.attachments) {
          if (attachment.frame.empty()) continue;
          attachment.offset.setZero();
          attachment.initial_pose = InitialPose{place.x(), 0, 0, 0, 0, 0};
        }
        World world(scene, initial_frames(scene));
        ASSERT_TRUE(world.apply(edit::SetLength{0, at_end, length, 0.2}).ok);
        BoundaryInputs inputs = initial_frames(scene);
        double fastest = 0;
        for (int i = 1; i <= 500; ++i) {
          const double sine = std::sin(2 * M_PI * 0.001 * i), turned = 0.3 * sine * sine, moved = 0.1 * sine * sine;
          const Vector3 axis = Vector3(0, 1, 1).normalized();
          inputs[1] = {Pose{place + Vector3(0, moved, moved), Quaternion(Eigen::AngleAxisd(turned, axis))}, true};
          ASSERT_EQ(world.step(inputs).status, Status::ok) << i;
          for (const Vector3& velocity : world.cables()[0].state.velocities) fastest = std::max(fastest, velocity.norm());
        }
        EXPECT_LT(fastest, 5) << at_end << rubs << length;
        EXPECT_EQ(world.ledger().unaccounted_steps, 0) << at_end << rubs << length;
        EXPECT_NEAR(world.ledger().unaccounted(), 0, 1e-4 * 0.04 * 9.81 * 0.4) << at_end << rubs << length;
      }
}

/// A hose whose strands rub hangs through an eyelet, clamped at both ends, of which one goes up and down: nodes pass the eyelet,
/// and no energy comes from nowhere.
TEST(YieldingState, PassesEyelets) {
  SceneDesc scene = scenes::one_cable(10, 1.2);
  MaterialDesc& material = scene.materials[0].material;
  material.linear_density = 0.04;
  material.bending_stiffness = 0.015;
  material.torsional_stiffness = 0.02;
  material.bending_damping = 3e-4;
  material.axial_stiffness = 2e4;
  material.bending_friction = 0.004;
  CableDesc& cable = scene.cables[0];
  cable.attachments = {scenes::attachment("hand", At::start, {0, 0, 0}, "hand", AttachmentType::clamp),
                       scenes::attachment("end", At::end, {0.72, 0, 0}, "", AttachmentType::clamp)};
  cable.attachments[0].initial_pose = InitialPose{0, 0, 0, 0, 0, 0};
  GuideDesc& guide = scene.guides.emplace_back();
  guide.name = "guide";
  guide.cable = "cable";
  guide.place = PlaceDesc{At::arc_length, 0.6};
  guide.offset = {0.36, 0, -0.1};
  guide.friction = 0.1;
  World world(scene, initial_frames(scene));
  BoundaryInputs inputs = initial_frames(scene);
  const double scale = 0.04 * 9.81 * 1.2 * 1.2;
  double before = yielded(world);
  for (int i = 1; i <= 1000; ++i) {
    inputs[1] = {Pose{{0, 0, 0.03 * std::pow(std::sin(2 * M_PI * 0.001 * i), 3)}, Quaternion::Identity()}, true};
    ASSERT_NE(world.step(inputs).status, Status::fault) << i;
    ASSERT_GE(yielded(world), before - 1e-15) << i;
    before = yielded(world);
    ASSERT_NEAR(world.ledger().unaccounted(), 0, 1e-5 * scale) << i;
  }
}

/// A wire that yields in an eyelet through which a hand draws it takes along what it remembers, and bends by more than a radian
/// from segment to segment there.
TEST(YieldingState, FlowsThroughGuides) {
  SceneDesc scene = scenes::one_cable(40, 2);
  MaterialDesc& material = scene.materials[0].material;
  material.bending_stiffness = 0.002;
  material.torsional_stiffness = 0.0015;
  material.bending_damping = 1e-4;
  material.yield_curvature = 3;
  material.hardening = 0.3;
  scene.cables[0].point_masses = {scenes::payload(0.2)};
  scene.cables[0].attachments = {scenes::attachment("grip", At::start, {0, 0, 0}, "hand")};
  scene.cables[0].attachments[0].initial_pose = InitialPose{-0.6, 0, 0, 0, 0, 0};
  GuideDesc& guide = scene.guides.emplace_back();
  guide.name = "guide";
  guide.cable = "cable";
  guide.place = PlaceDesc{At::arc_length, 1};
  guide.friction = 0.1;
  World world(scene, initial_frames(scene));
  BoundaryInputs inputs = initial_frames(scene);
  for (int i = 0; i < 800; ++i) {
    const double sine = std::sin(0.004 * i);
    inputs[1] = {Pose{{-0.6 - 0.1 * sine * sine, 0, 0}, Quaternion::Identity()}, true};
    ASSERT_EQ(world.step(inputs).status, Status::ok) << i;
  }
  EXPECT_GT(yielded(world), 0.05);
  EXPECT_NEAR(world.ledger().unaccounted(), 0, 1e-4 * 0.4 * 9.81 * 2);
}

/// Numbers that change while it runs: what was bent for good stays so.
TEST(YieldingState, StaysWhenItsMaterialIsTuned) {
  SceneDesc scene = yielding_wire();
  scene.materials[0].material.bending_friction = 0;
  World world(scene, initial_frames(scene));
  bend_it(0, 3, 1000, world);
  const std::vector<double> before = plastic_curvature(world.cables()[0]);
  SceneDesc tuned = world.scene();
  tuned.materials[0].material.yield_curvature = 100;
  world.tune(tuned);
  bend_it(3, 0, 1000, world);
  const std::vector<double> after = plastic_curvature(world.cables()[0]);
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_NEAR(after[i], before[i], 1e-12) << i;
  tuned.materials[0].material.bending_friction = 0.01;
  world.tune(tuned);
  bend_it(0, 3, 1000, world);
  EXPECT_GT(yielded(world), 0);
  SceneDesc plain = wire();
  World starts_plain(plain, initial_frames(plain));
  ASSERT_TRUE(starts_plain.cables()[0].state.directors.empty());
  plain.materials[0].material.bending_friction = 0.01;
  starts_plain.tune(plain);
  bend_it(0, 3, 1000, starts_plain);
  EXPECT_GT(yielded(starts_plain), 0.5 * 0.01 * 3);
}

}  // namespace
}  // namespace verlet_cable

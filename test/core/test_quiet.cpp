#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "../support/scenes.h"

// Motion that steps cannot resolve dies out; what they resolve stays as it is.

namespace verlet_cable {
namespace {

constexpr double g = 9.81;
constexpr double weight = 0.1 * g;  // [N] of `scenes::one_cable`

struct Material {
  AttachmentType type;
  double bending_stiffness, bending_damping, axial_stiffness;
  double second_stiffness = 0;  ///< about the material's z axis; 0: the same about both
};

void PrintTo(const Material& m, std::ostream* out) {
  *out << (m.type == AttachmentType::clamp ? "clamps" : "hinges") << ", EI " << m.bending_stiffness << ", damping "
       << m.bending_damping << ", EA " << m.axial_stiffness << (m.second_stiffness > 0 ? ", a ribbon" : "");
}

/// Between the frames "left" and "right" on a level, 0.4 m apart.
SceneDesc between_hands(const Material& material, double drag = 0.05) {
  SceneDesc scene = scenes::one_cable(50);
  MaterialDesc& m = scene.materials[0].material;
  m.bending_stiffness = material.bending_stiffness;
  if (material.second_stiffness > 0) {
    m.bending_stiffness = {material.bending_stiffness, material.second_stiffness};
    m.torsional_stiffness = 0.75 * material.second_stiffness;
    m.torsional_damping = material.bending_damping;
  }
  m.bending_damping = material.bending_damping;
  m.axial_stiffness = material.axial_stiffness;
  m.axial_damping = material.axial_stiffness < infinity ? 1 : 0;
  m.drag = drag;
  scene.cables[0].attachments = {scenes::attachment("a", PlaceDesc::At::start, {0, 0, 0}, "left", material.type),
                                 scenes::attachment("b", PlaceDesc::At::end, {0, 0, 0}, "right", material.type)};
  scene.cables[0].initial.type = InitialShapeDesc::Type::settled;
  return scene;
}

BoundaryInputs hands() {
  BoundaryInputs inputs(3);
  inputs[2].pose.position = {0.4, 0, 0};
  return inputs;
}

struct Noise {
  double velocity = 0;  ///< [m/s] largest difference from the rate of the places
  double tension = 0;   ///< [weights] largest change in a step
};

/// Over 0.1 s from now on; `move` is given the time.
Noise listen(World& world, BoundaryInputs inputs, const std::function<void(double, BoundaryInputs&)>& move) {
  Noise noise;
  const double h = world.time_step();
  std::vector<std::vector<SimulatedCable>> last;
  for (int i = 0; i < std::lround(0.1 / h); ++i) {
    if (move) move(world.time() + h, inputs);
    world.step(inputs);
    last.push_back(world.cables());
    if (last.size() > 3) last.erase(last.begin());
    if (last.size() < 3) continue;
    for (std::size_t c = 0; c < last[0].size(); ++c) {
      const CableState &before = last[0][c].state, &state = last[1][c].state, &after = last[2][c].state;
      for (std::size_t k = 0; k < state.positions.size(); ++k) {
        const Vector3 rate = (after.positions[k] - before.positions[k]) / (2 * h);
        noise.velocity = std::max(noise.velocity, (rate - state.velocities[k]).norm());
      }
      for (std::size_t k = 0; k < state.tension.size(); ++k)
        noise.tension = std::max(noise.tension, std::abs(after.tension[k] - state.tension[k]) / weight);
    }
  }
  return noise;
}

void run(World& world, BoundaryInputs inputs, double until, const std::function<void(double, BoundaryInputs&)>& move = nullptr) {
  while (world.time() < until - 1e-9) {
    if (move) move(world.time() + world.time_step(), inputs);
    ASSERT_LT(world.step(inputs).status, StepResult::Status::degraded);
  }
}

void expect_quiet(const Noise& noise) {
  EXPECT_LT(noise.velocity, 0.01);
  EXPECT_LT(noise.tension, 0.02);
}

class Quiet : public testing::TestWithParam<Material> {};

TEST_P(Quiet, AfterHandsHaveJerked) {
  // 0.02 m within 5 ms is a motion, which strikes the cable; 0.1 m within 2 ms a jump, which carries it along.
  for (const auto& [way, duration] : {std::pair(0.02, 0.005), std::pair(0.1, 0.002)}) {
    SCOPED_TRACE(testing::Message() << way << " m in " << duration << " s");
    const auto move = [way = way, duration = duration](double time, BoundaryInputs& inputs) {
      const Vector3 shift = way * std::clamp((time - 0.1) / duration, 0.0, 1.0) * Vector3(0.96, 0, 0.28);
      inputs[1].pose.position = shift;
      inputs[2].pose.position = Vector3(0.4, 0, 0) + shift;
    };
    World world(between_hands(GetParam()), hands());
    run(world, hands(), 0.1 + duration + 0.2, move);
    expect_quiet(listen(world, hands(), move));
  }
}

TEST_P(Quiet, AfterAStartThatIsNoEquilibrium) {
  SceneDesc scene = between_hands(GetParam());
  scene.cables[0].initial.type = InitialShapeDesc::Type::points;
  const double depth = std::sqrt(0.25 - 0.04);
  scene.cables[0].initial.points = {{0, 0, 0}, {0.2, 0, -depth}, {0.4, 0, 0}};
  World world(scene, hands());
  run(world, hands(), 0.2);
  expect_quiet(listen(world, hands(), nullptr));
}

TEST_P(Quiet, AfterACut) {
  World world(between_hands(GetParam()), hands());
  run(world, hands(), 0.1);
  ASSERT_TRUE(world.apply(edit::Cut{cable_id(0), 25}).ok);
  run(world, hands(), 0.3);
  const Noise noise = listen(world, hands(), nullptr);
  EXPECT_LT(noise.velocity, 0.01);
}

INSTANTIATE_TEST_SUITE_P(
    Materials, Quiet,
    testing::Values(Material{AttachmentType::hinge, 1e-3, 5e-4, infinity}, Material{AttachmentType::hinge, 0.01, 5e-4, infinity},
                    Material{AttachmentType::clamp, 0.01, 5e-4, infinity}, Material{AttachmentType::clamp, 0.05, 2e-3, infinity},
                    Material{AttachmentType::clamp, 0.1, 5e-4, infinity}, Material{AttachmentType::clamp, 0.01, 5e-4, 1e4},
                    Material{AttachmentType::clamp, 0.05, 1e-3, infinity, 0.01},
                    Material{AttachmentType::hinge, 0.05, 1e-3, infinity, 0.01}));

TEST(Quiet, AfterAClampHasTurnedItsForcesAreThoseOfEquilibrium) {
  for (const double bending : {1e-2, 0.05}) {
    World world(between_hands({AttachmentType::clamp, bending, 2e-3, infinity}, 1.0), hands());
    BoundaryInputs inputs = hands();
    run(world, inputs, 0.1);
    inputs[1].pose.orientation = Quaternion(Eigen::AngleAxisd(0.5, Vector3::UnitY()));
    run(world, inputs, 0.3);
    expect_quiet(listen(world, inputs, nullptr));
    run(world, inputs, 2.1);
    World standing = world;
    ASSERT_TRUE(standing.settle());
    for (const int hand : {0, 1}) {
      const Vector3 force = standing.attachments()[hand].force;
      EXPECT_LT((world.attachments()[hand].force - force).norm(), 0.005 * force.norm()) << bending << " " << hand;
    }
  }
}

/// The right hand as tf gives it from 10 poses a second, straight between them.
Vector3 shaken_hand(double time) {
  const auto path = [](double t) {
    const double u = std::min(t / 0.5, 1.0), grown = u * u * u * (10 - 15 * u + 6 * u * u), phase = 4 * M_PI * t;
    return Vector3(0.4 + 0.05 * grown * std::sin(phase), 0, 0.05 * grown * (1 - std::cos(phase)));
  };
  const double before = 0.1 * std::floor(10 * time + 1e-9), part = 10 * (time - before);
  return (1 - part) * path(before) + part * path(before + 0.1);
}

Vector3 momentum(const CableState& state) {
  Vector3 sum = Vector3::Zero();
  for (int i = 0; i < state.nodes(); ++i) sum += state.masses[i] * state.velocities[i];
  return sum;
}

/// Forces on the left hand [N], means over 20 ms.
std::vector<Vector3> forces_on_the_left(SceneDesc scene, double time_step) {
  scene.time_step = time_step;
  World world(scene, hands());
  BoundaryInputs inputs = hands();
  std::vector<Vector3> means;
  const long part = std::lround(0.02 / time_step);
  for (long i = 0; i < 75 * part; ++i) {
    inputs[2].pose.position = shaken_hand(world.time() + time_step);
    world.step(inputs);
    if (i % part == 0) means.emplace_back(Vector3::Zero());
    means.back() += world.attachments()[0].force / part;
  }
  return means;
}

TEST(Quiet, AShakenHandIsFeltAtTheOtherAsInShorterSteps) {
  for (const Material& material :
       {Material{AttachmentType::hinge, 1e-3, 1e-3, infinity}, Material{AttachmentType::hinge, 0.01, 1e-3, infinity},
        Material{AttachmentType::clamp, 0.01, 1e-3, infinity}, Material{AttachmentType::clamp, 0.05, 1e-3, 1e4}}) {
    const std::vector<Vector3> coarse = forces_on_the_left(between_hands(material), 1e-3);
    const std::vector<Vector3> fine = forces_on_the_left(between_hands(material), 1e-4);
    double largest = 0, difference = 0;
    for (std::size_t i = 0; i < fine.size(); ++i) {
      largest = std::max(largest, fine[i].norm());
      difference = std::max(difference, (coarse[i] - fine[i]).norm());
    }
    EXPECT_LT(difference, 0.02 * largest) << testing::PrintToString(material);
  }
}

/// Also what keeps lengths where hands change their velocities, and what is taken out of velocities.
TEST(Quiet, ForcesOnTheHandsAddUpToMomentum) {
  for (const double stiffness : {infinity, 1e4})
    for (const double time_step : {1e-3, 1e-4}) {
      SceneDesc scene = between_hands({AttachmentType::hinge, 0.01, 1e-3, stiffness}, 0);
      scene.time_step = time_step;
      World world(scene, hands());
      BoundaryInputs inputs = hands();
      Vector3 before, impulse = Vector3::Zero();
      double most = 0;
      for (int i = 0; i * time_step < 1; ++i) {
        inputs[2].pose.position = shaken_hand(world.time() + time_step);
        world.step(inputs);
        if (i == 0) before = momentum(world.cables()[0].state);  // the cable begins with its hands
        if (i == 0) continue;
        impulse += time_step * (Vector3(0, 0, -weight) - world.attachments()[0].force - world.attachments()[1].force);
        const Vector3 gained = momentum(world.cables()[0].state) - before;
        most = std::max(most, (gained - impulse).norm());
      }
      // Of 0.03 N s that come and go; a node moves by 1e-8 m where the iteration ends.
      EXPECT_LT(most, 1e-4) << stiffness << " " << time_step;
    }
}

/// Half of the velocities are of a motion that alternates, as a hard knock leaves it behind.
TEST(Quiet, AFreeCableKeepsItsMomenta) {
  SceneDesc scene = scenes::one_cable(50);
  scene.gravity.acceleration.setZero();
  scene.materials[0].material.bending_stiffness = 0.05;
  scene.materials[0].material.bending_damping = 1e-3;
  scene.cables[0].initial.type = InitialShapeDesc::Type::points;
  for (int i = 0; i <= 50; ++i) {
    scene.cables[0].initial.points.push_back({0.02 * i, 0, 0});
    scene.cables[0].initial.velocities.push_back({1, i % 2 ? 3.0 : -3.0, 0.06 * i});
  }
  World world(scene, {});
  const auto momenta = [&] {
    const SimulatedCable& cable = world.cables()[0];
    Eigen::Matrix<double, 6, 1> sum = Eigen::Matrix<double, 6, 1>::Zero();
    for (int i = 0; i < cable.state.nodes(); ++i) {
      const Vector3 p = cable.state.masses[i] * cable.state.velocities[i];
      sum.head<3>() += p;
      sum.tail<3>() += cable.state.positions[i].cross(p);
    }
    return sum;
  };
  const Eigen::Matrix<double, 6, 1> before = momenta();
  run(world, {}, 0.2);
  expect_quiet(listen(world, {}, nullptr));
  EXPECT_LT((momenta() - before).norm(), 1e-9 * before.norm());
}

/// What is taken out is no more than what alternates: nothing of a swing, next to nothing of a whip before it cracks.
TEST(Quiet, WhatIsResolvedKeepsItsEnergy) {
  for (const int segments : {20, 100, 200}) {
    const SceneDesc scene = scenes::released(segments, M_PI / 2);
    World world(scene, initial_frames(scene));
    const double energy = world.energy().total();
    double most = 0;
    for (int i = 0; i < 1000; ++i) {
      world.step(initial_frames(scene));
      most = std::max(most, world.energy().total() - energy);
    }
    EXPECT_LT(most, 1e-5 * weight) << segments;
    EXPECT_GT(world.energy().total() - energy, -1e-3 * weight) << segments;
  }
}

/// However much it is damped, and whether it is stiff or not: it bends at a corner, and turns.
TEST(DampedFreeCable, NeverGainsEnergy) {
  struct Bending {
    double stiffness, damping;
    bool keeps_angular_momentum;
  };
  for (const Bending& bending : {Bending{0, 0.1, false},
                                 {0, 0.01, false},
                                 {0, 0.001, false},
                                 {0.02, 0.1, false},
                                 {0.02, 0.01, true},
                                 {0.02, 0.001, true}}) {
    SceneDesc scene = scenes::one_cable(20);
    scene.gravity.acceleration.setZero();
    scene.numerical_damping = false;
    scene.materials[0].material.bending_stiffness = bending.stiffness;
    scene.materials[0].material.bending_damping = bending.damping;
    scene.cables[0].initial.type = InitialShapeDesc::Type::points;
    scene.cables[0].initial.points = {{0, 0, 0}, {0.5, 0, 0}, {0.5, 0.5, 0}};
    scene.cables[0].initial.velocities = {{0, 1, 0}, {0, -2, 1}, {3, 0, 1}};
    World world(scene, initial_frames(scene));
    const auto angular_momentum = [&] {
      const CableState& state = world.cables()[0].state;
      double mass = 0;
      Vector3 moment = Vector3::Zero(), momentum = Vector3::Zero(), sum = Vector3::Zero();
      for (int i = 0; i < state.nodes(); ++i) {
        mass += state.masses[i];
        moment += state.masses[i] * state.positions[i];
        momentum += state.masses[i] * state.velocities[i];
        sum += state.masses[i] * state.positions[i].cross(state.velocities[i]);
      }
      return Vector3(sum - moment.cross(momentum) / mass);
    };
    const Vector3 start = angular_momentum();
    const double energy = world.energy().total();
    double last = energy;
    for (int i = 0; i < 2500; ++i) {
      ASSERT_EQ(world.step(initial_frames(scene)).status, StepResult::Status::ok);
      ASSERT_LT(world.energy().total(), last + 1e-5 * energy) << bending.stiffness << ' ' << bending.damping << ' ' << i;
      last = world.energy().total();
    }
    if (bending.keeps_angular_momentum) EXPECT_LT((angular_momentum() - start).norm(), 1e-4 * start.norm());
  }
}

/// Its motion becomes chaotic after some seconds, and as fast as the step is long: what is lost is the mean of some runs.
TEST(Quiet, AFastCantileverLosesLittle) {
  constexpr int runs = 24, segments = 40;
  double left = 0;
  for (int run = 0; run < runs; ++run) {
    SceneDesc scene = scenes::one_cable(segments);
    scene.gravity.acceleration.setZero();
    scene.materials[0].material.bending_stiffness = 0.02;
    scene.cables[0].attachments = {scenes::attachment("a", PlaceDesc::At::start, {0, 0, 0}, "", AttachmentType::clamp)};
    scene.cables[0].initial.type = InitialShapeDesc::Type::points;
    for (int i = 0; i <= segments; ++i) {
      const double s = static_cast<double>(i) / segments;
      scene.cables[0].initial.points.push_back({s, 0, 0});
      scene.cables[0].initial.velocities.push_back({0, (6 + 1e-6 * run) * s * s, 0});
    }
    World world(scene, initial_frames(scene));
    const double energy = world.energy().total();
    for (int i = 0; i < 3000; ++i) world.step(initial_frames(scene));
    EXPECT_NEAR(world.energy().total(), energy, 1e-2 * energy);
    for (int i = 0; i < 7000; ++i) world.step(initial_frames(scene));
    left += world.energy().total() / energy / runs;
  }
  EXPECT_GT(left, 0.945);
}

TEST(Quiet, AWhipInShortStepsKeepsItsEnergyAfterItCracked) {
  SceneDesc scene = scenes::released(50, M_PI / 2);
  scene.time_step = 2.5e-4;
  World world(scene, initial_frames(scene));
  const double energy = world.energy().total();
  run(world, initial_frames(scene), 2);
  EXPECT_NEAR(world.energy().total(), energy, 1e-2 * weight);
}

TEST(Quiet, AnElasticCableThatIsLetGoGainsNoEnergy) {
  for (const double stiffness : {3e3, 3e4})
    for (const bool held : {false, true}) {
      SceneDesc scene = scenes::one_cable(50);
      scene.materials[0].material.axial_stiffness = stiffness;
      if (held) scene.cables[0].attachments = {scenes::attachment("a", PlaceDesc::At::start, {0, 0, 0})};
      scene.cables[0].initial.type = InitialShapeDesc::Type::points;
      scene.cables[0].initial.points = {{0, 0, 0}, {1.02, 0, 0}};
      World world(scene, initial_frames(scene));
      const double energy = world.energy().total();
      for (int i = 0; i < 2000; ++i) {
        world.step(initial_frames(scene));
        ASSERT_LT(world.energy().total(), energy + 1e-4) << stiffness << " " << held << " " << i;
      }
    }
}

/// The mean moment at a clamp is that of an energy, which depends on how the segment there is stretched.
TEST(Quiet, AClampKeepsTheEnergyOfAnElasticCable) {
  for (const double stiffness : {1e3, 1e4}) {
    SceneDesc scene = scenes::one_cable(40);
    scene.numerical_damping = false;
    scene.materials[0].material.axial_stiffness = stiffness;
    scene.materials[0].material.bending_stiffness = 0.02;
    scene.cables[0].attachments = {scenes::attachment("a", PlaceDesc::At::start, {0, 0, 0}, "", AttachmentType::clamp)};
    scene.cables[0].initial.type = InitialShapeDesc::Type::straight;
    scene.cables[0].initial.to = {1, 0, 0};
    World world(scene, initial_frames(scene));
    const double energy = world.energy().total();
    run(world, initial_frames(scene), 3);
    // Of 0.33 J that come and go.
    EXPECT_NEAR(world.energy().total(), energy, 3e-5) << stiffness;
  }
}

TEST(Quiet, AnElasticCableIsNotStretchedByBeingCarriedAlong) {
  World world(between_hands({AttachmentType::hinge, 0.01, 5e-4, 1e4}), hands());
  run(world, hands(), 0.1);
  BoundaryInputs inputs = hands();
  inputs[2].pose.position.x() += 0.1;
  EXPECT_EQ(world.step(inputs).status, StepResult::Status::jumped);
  for (int i = 0; i < 50; ++i) EXPECT_LT(std::abs(strain(world.cables()[0].state, i)), 1e-4) << i;
}

/// What alternates from step to step is not in the tension; its impulse is, a step later.
TEST(Quiet, TensionsAddUpToImpulses) {
  SceneDesc scene = scenes::one_cable(20);
  scene.cables[0].attachments = {scenes::attachment("a", PlaceDesc::At::start, {0, 0, 0})};
  scene.materials[0].material.axial_stiffness = 1e4;
  scene.cables[0].initial.type = InitialShapeDesc::Type::points;
  scene.cables[0].initial.points = {{0, 0, 0}, {0, 0, -1.001}};
  World world(scene, initial_frames(scene));
  double shown = 0, impulse = 0, first = 0, last = 0;
  for (int i = 0; i < 7; ++i) {
    world.step(initial_frames(scene));
    last = world.cables()[0].state.last_tension[3];
    if (i == 0) first = last;
    shown += world.cables()[0].state.tension[3];
    impulse += last;
  }
  EXPECT_GT(std::abs(first - last), 0.1 * std::abs(first));
  EXPECT_NEAR(shown, impulse + 0.5 * (first - last), 1e-12);
}

TEST(Quiet, WithoutNumericalDampingItGoesOn) {
  SceneDesc scene = between_hands({AttachmentType::clamp, 0.05, 2e-3, infinity});
  scene.numerical_damping = false;
  World world(scene, hands());
  BoundaryInputs inputs = hands();
  run(world, inputs, 0.1);
  inputs[1].pose.orientation = Quaternion(Eigen::AngleAxisd(0.5, Vector3::UnitY()));
  run(world, inputs, 2);
  EXPECT_GT(listen(world, inputs, nullptr).velocity, 0.1);
}

TEST(Quiet, ACopyGoesOnAlikeWhileStepsDamp) {
  SceneDesc scene = scenes::released(100, M_PI / 2);
  scene.time_step = 0.02;
  World world(scene, initial_frames(scene));
  int damped = 0;
  for (int i = 0; i < 100; ++i) {
    world.step(initial_frames(scene));
    if (world.cables()[0].state.unresolved.damped == 0) continue;
    World copy = world;
    ++damped;
    for (int k = 0; k < 3; ++k) {
      world.step(initial_frames(scene));
      copy.step(initial_frames(scene));
      ASSERT_EQ(copy.hash(), world.hash());
    }
  }
  EXPECT_GT(damped, 0);
}

/// An edit changes accelerations at a stroke, which is no sign of anything.
TEST(Quiet, AfterAnEditMotionIsJudgedAnew) {
  World world(between_hands({AttachmentType::hinge, 0.01, 5e-4, infinity}), hands());
  run(world, hands(), 0.1);
  EXPECT_EQ(world.cables()[0].state.unresolved.known, 2);
  ASSERT_TRUE(world.apply(edit::Cut{cable_id(0), 25}).ok);
  for (const SimulatedCable& cable : world.cables()) {
    EXPECT_EQ(cable.state.unresolved.known, 0);
    EXPECT_EQ(cable.state.unresolved.acceleration_changes.size(), cable.state.positions.size());
  }
}

}  // namespace
}  // namespace verlet_cable

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "../support/scenes.h"
#include "rod/lateral_stiffness.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {
namespace {

using Type = AttachmentType;

/// [m] and [N s/m^2]: light, so that what buckles comes to rest.
constexpr double mass_density = 0.1, drag = 0.3;

/// 1 m from the origin towards the frame "hand", exactly straight, without gravity.
SceneDesc column(double axial_stiffness, double bending_stiffness, Type first = Type::hinge, Type last = Type::hinge,
                 const Vector3& direction = Vector3::UnitX()) {
  SceneDesc scene = scenes::one_cable(40);
  scene.time_step = 1e-3;
  scene.gravity.acceleration = Vector3::Zero();
  MaterialDesc& material = scene.materials[0].material;
  material.linear_density = mass_density;
  material.axial_stiffness = axial_stiffness;
  material.bending_stiffness = bending_stiffness;
  material.bending_damping = 0.02 * bending_stiffness;
  material.drag = drag;
  scene.cables[0].initial.type = InitialShapeDesc::Type::straight;
  scene.cables[0].initial.to = direction;
  scene.cables[0].attachments = {scenes::attachment("base", PlaceDesc::At::start, {0, 0, 0}, "", first),
                                 scenes::attachment("grip", PlaceDesc::At::end, {0, 0, 0}, "hand", last)};
  return scene;
}

/// For a column along x, or held by hinges.
BoundaryInputs hand(double distance, const Vector3& direction = Vector3::UnitX()) {
  return scenes::hand_at(distance * direction);
}

double aside(const World& world, const Vector3& direction = Vector3::UnitX()) {
  double most = 0;
  for (const Vector3& position : world.cables()[0].state.positions)
    most = std::max(most, (position - position.dot(direction) * direction).norm());
  return most;
}

/// Most of what happened.
struct Extremes {
  double kinetic = 0, total = 0, force = 0, strain = 0;
};

/// Pushes the ends together by so much at a speed [m/s], from where they are, and holds them for some time [s].
Extremes push(double from, double by, double speed, double time, World& world, const Vector3& direction = Vector3::UnitX()) {
  Extremes most;
  const double step = world.time_step();
  const int steps = static_cast<int>(std::lround((by / speed + time) / step));
  for (int i = 1; i <= steps; ++i) {
    const StepResult result = world.step(hand(from - std::min(by, speed * step * i), direction));
    EXPECT_EQ(result.status, StepResult::Status::ok) << "step " << i;
    most.kinetic = std::max(most.kinetic, world.energy().kinetic);
    most.total = std::max(most.total, world.energy().total());
    most.force = std::max(most.force, world.attachments()[1].force.norm());
    most.strain = std::max(most.strain, result.max_strain);
  }
  return most;
}

/// A column of 1 m that is buckled: the ends are (2 E(k) / K(k) - 1) m apart (Love, A Treatise on the Mathematical Theory of
/// Elasticity, 263).
struct Elastica {
  double modulus = 0;
  explicit Elastica(double distance) {
    double above = 1;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (modulus + above);
      (2 * std::comp_ellint_2(middle) / std::comp_ellint_1(middle) - 1 > distance ? modulus : above) = middle;
    }
  }
  double deflection() const { return modulus / std::comp_ellint_1(modulus); }
  /// [1/m^2] Times EI: the load; between clamps it is four times that.
  double load() const { return std::pow(2 * std::comp_ellint_1(modulus), 2); }
};

TEST(LateralStiffness, ChangesSignAtEulersLoads) {
  const SceneDesc scene = column(1e4, 0.5);
  const World world(scene, hand(1));
  const SimulatedCable& cable = world.cables()[0];
  struct Case {
    bool first, last;
    double number;
  };
  for (const Case& ends : {Case{false, false, 1}, Case{true, false, 2.0457}, Case{false, true, 2.0457}, Case{true, true, 4}}) {
    const StraightSpan span{0, 40, ends.first, ends.last};
    const double load = ends.number * M_PI * M_PI * 0.5;
    // Of 40 segments; the error is that of a chain, below pi^2 / (3 n^2) of the load.
    EXPECT_TRUE(LateralStiffness(*cable.model, cable.state, span, std::vector<double>(40, -0.995 * load)).is_stable());
    LateralStiffness beyond(*cable.model, cable.state, span, std::vector<double>(40, -1.005 * load));
    EXPECT_FALSE(beyond.is_stable());
    const std::vector<double> shape = beyond.growing_shape();
    ASSERT_EQ(shape.size(), 41u);
    // One half wave, all on one side.
    EXPECT_GT(*std::min_element(shape.begin() + 1, shape.end() - 1) * *std::max_element(shape.begin() + 1, shape.end() - 1), 0);
  }
}

TEST(StraightColumn, ThatCannotStretchGivesWayAtOnce) {
  for (const double time_step : {1e-3, 5e-3})
    for (const double bending_stiffness : {0.0, 1e-2})
      for (const Type end : {Type::hinge, Type::clamp}) {
        SCOPED_TRACE(std::to_string(time_step) + ", " + std::to_string(bending_stiffness));
        SceneDesc scene = column(infinity, bending_stiffness, Type::hinge, end);
        scene.time_step = time_step;
        World world(scene, hand(1));
        const Extremes most = push(1, 0.1, 0.1, 0, world);
        // They were 0.1 and 5e6 N.
        EXPECT_LT(most.strain, 1e-4);
        EXPECT_LT(most.force, 250);
        // Of a neighbour that is not quite straight, 19 J and more.
        EXPECT_LT(most.kinetic, 0.1);
        EXPECT_GT(aside(world), 0.02);
      }
}

TEST(StraightColumn, SettlesAsElastica) {
  constexpr double bending_stiffness = 0.01, by = 0.1;
  const Elastica elastica(1 - by);
  for (const double axial_stiffness : {infinity, 1e4})
    for (const double time_step : {1e-3, 5e-3})
      for (const Type ends : {Type::hinge, Type::clamp}) {
        SCOPED_TRACE(std::to_string(axial_stiffness) + ", " + std::to_string(time_step));
        SceneDesc scene = column(axial_stiffness, bending_stiffness, ends, ends);
        scene.time_step = time_step;
        World world(scene, hand(1));
        push(1, by, 0.1, 10, world);
        // Of 40 segments.
        EXPECT_NEAR(aside(world), elastica.deflection(), 0.003);
        const double load = (ends == Type::clamp ? 4 : 1) * elastica.load() * bending_stiffness;
        EXPECT_NEAR(world.attachments()[1].force.x(), load, 0.02 * load);
      }
}

TEST(StraightColumn, ThatCanStretchStaysStraightBelowItsEulerLoad) {
  constexpr double bending_stiffness = 0.5, axial_stiffness = 1e4;
  struct Case {
    Type first, last;
    double number;
  };
  for (const Case& ends :
       {Case{Type::hinge, Type::hinge, 1}, Case{Type::clamp, Type::hinge, 2.0457}, Case{Type::clamp, Type::clamp, 4}}) {
    SCOPED_TRACE(ends.number);
    const double load = ends.number * M_PI * M_PI * bending_stiffness;
    SceneDesc scene = column(axial_stiffness, bending_stiffness, ends.first, ends.last);
    scene.materials[0].material.axial_damping = 10;
    World world(scene, hand(1));
    push(1, 0.95 * load / axial_stiffness, 1e-2, 1, world);
    EXPECT_EQ(aside(world), 0);
    EXPECT_NEAR(world.attachments()[1].force.norm(), 0.95 * load, 0.01 * load);
    push(1 - 0.95 * load / axial_stiffness, 1.05 * load / axial_stiffness, 1e-2, 5, world);
    EXPECT_GT(aside(world), 0.01);
    EXPECT_NEAR(world.attachments()[1].force.norm(), load, 0.02 * load);
  }
}

TEST(StraightColumn, BucklesTowardsWhereItBendsMoreEasily) {
  SceneDesc scene = column(infinity, 0);
  scene.materials[0].material.bending_stiffness = {0.001, 0.01};
  scene.materials[0].material.torsional_stiffness = 0.005;
  World world(scene, hand(1));
  push(1, 0.05, 0.1, 0, world);
  double y = 0, z = 0;
  for (const Vector3& position : world.cables()[0].state.positions) {
    y = std::max(y, std::abs(position.y()));
    z = std::max(z, std::abs(position.z()));
  }
  EXPECT_LT(y, 1e-9);
  EXPECT_GT(z, 0.05);
}

/// Bending of hinged ends as near as that, of the elastica, is 0.0101, 0.057 and 0.12 J.
TEST(StraightColumn, WhoseEndsJumpTogetherGetsNoEnergyButThatOfItsBow) {
  for (const Vector3& direction : {Vector3(Vector3::UnitX()), Vector3(Vector3::UnitZ()), Vector3(Vector3(1, 2, 3).normalized())})
    for (const double axial_stiffness : {infinity, 1e4})
      for (const double bending_stiffness : {0.0, 0.01})
        for (const double by : {0.1, 0.5, 0.9}) {
          SCOPED_TRACE(std::to_string(axial_stiffness) + ", " + std::to_string(bending_stiffness) + ", " + std::to_string(by));
          World world(column(axial_stiffness, bending_stiffness, Type::hinge, Type::hinge, direction), hand(1, direction));
          EXPECT_EQ(world.step(hand(1 - by, direction)).status, StepResult::Status::jumped);
          EXPECT_LT(world.energy().total(), bending_stiffness * (by < 0.2 ? 1.1 : by < 0.6 ? 6 : 13) + 1e-5);
          for (int i = 0; i < 200; ++i) {
            world.step(hand(1 - by, direction));
            ASSERT_LT(world.energy().kinetic, 0.3 * bending_stiffness + 1e-5);
          }
        }
}

/// Too short a way to be a jump. What moves for that step has no more energy than the holder's velocity can give.
TEST(StraightColumn, ThatIsPushedForASingleStepComesToRest) {
  for (const double by : {1e-6, 1e-4, 1e-3, 4e-3}) {
    SCOPED_TRACE(by);
    World world(column(infinity, 0), hand(1));
    const double velocity = by / world.time_step();
    const Extremes most = push(1, by, velocity, 0.2, world);
    EXPECT_LT(most.total, 0.2 * velocity);
    EXPECT_LT(most.strain, 1e-3);
    EXPECT_LT(world.energy().kinetic, 0.1 * most.total);
  }
}

/// Gravity pulls aside what is pushed, too.
TEST(StraightColumn, ThatIsPushedFarInALongStepConverges) {
  for (const double by : {0.01, 0.03, 0.05, 0.09}) {
    SceneDesc scene = column(infinity, 0);
    scene.cables[0].segments = 80;
    scene.time_step = 0.02;
    scene.gravity.acceleration = {0, 0, -9.81};
    World world(scene, hand(1));
    EXPECT_EQ(world.step(hand(1 - by)).status, StepResult::Status::ok) << by;
  }
}

TEST(StraightColumn, BucklesAlikeInAllDirections) {
  std::vector<double> deflections;
  for (const Vector3& direction :
       {Vector3(Vector3::UnitX()), Vector3(Vector3::UnitZ()), Vector3(Vector3(1, 2, 3).normalized())}) {
    World world(column(infinity, 0.01, Type::hinge, Type::hinge, direction), hand(1, direction));
    push(1, 0.02, 0.1, 0, world, direction);
    deflections.push_back(aside(world, direction));
  }
  EXPECT_NEAR(deflections[1], deflections[0], 1e-6);
  EXPECT_NEAR(deflections[2], deflections[0], 1e-6);
}

TEST(StraightColumn, BetweenClampsWithoutBendingStiffnessGivesWay) {
  for (const double axial_stiffness : {infinity, 1e4}) {
    World world(column(axial_stiffness, 0, Type::clamp, Type::clamp), hand(1));
    const Extremes most = push(1, 0.1, 0.1, 0, world);
    EXPECT_LT(most.force, 250);
    EXPECT_GT(aside(world), 0.005);
  }
}

/// Its upper half hangs and its lower half stands.
TEST(StraightColumn, StandsNotWithoutBendingStiffness) {
  SceneDesc scene = column(1e4, 0, Type::hinge, Type::hinge, Vector3::UnitZ());
  scene.gravity.acceleration = {0, 0, -9.81};
  const Vector3 up = Vector3::UnitZ();
  World world(scene, hand(1, up));
  for (int i = 0; i < 5000; ++i) world.step(hand(1, up));
  EXPECT_GT(aside(world, up), 5e-4);
  const std::vector<double>& tension = world.cables()[0].state.tension;
  // The weight is 0.98 N: half of it would press from below.
  EXPECT_GT(*std::min_element(tension.begin(), tension.end()), -0.25);
}

TEST(StraightColumn, ThatIsPulledMovedOrStandsStaysExactlyStraight) {
  for (const double axial_stiffness : {infinity, 1e4})
    for (const double bending_stiffness : {0.0, 0.01})
      for (const double speed : {0.0, 0.2}) {
        SceneDesc scene = column(axial_stiffness, bending_stiffness);
        scene.cables[0].attachments[0].frame = "other";
        const auto inputs = [&](int i) {
          BoundaryInputs all(3);
          all[1].pose.position = {speed * 1e-3 * i, 0, 0};
          all[2].pose.position = {1 + speed * 1e-3 * i + (axial_stiffness < infinity ? 1e-5 * i : 0), 0, 0};
          return all;
        };
        World world(scene, inputs(0));
        for (int i = 1; i <= 200; ++i) world.step(inputs(i));
        EXPECT_EQ(aside(world), 0);
      }
}

TEST(StraightColumn, IsNotSettledAboveItsEulerLoad) {
  constexpr double bending_stiffness = 0.01;
  for (const double axial_stiffness : {infinity, 1e4})
    for (const Type ends : {Type::hinge, Type::clamp}) {
      SCOPED_TRACE(axial_stiffness);
      const double load = (ends == Type::clamp ? 4 : 1) * M_PI * M_PI * bending_stiffness;
      SceneDesc scene = column(axial_stiffness, bending_stiffness, ends, ends);
      World world(scene, hand(1));
      // Far too fast for it to have buckled by itself: what has begun to, in waves, may settle in them.
      world.step(hand(0.999));
      ASSERT_TRUE(world.settle());
      const double slack = 1e-3 - (axial_stiffness < infinity ? load / axial_stiffness : 0);
      EXPECT_NEAR(aside(world), Elastica(1 - slack).deflection(), 1e-4);
      // The load does not depend on the slack, to first order.
      EXPECT_NEAR(world.attachments()[1].force.x(), load, 0.01 * load);
    }
}

}  // namespace
}  // namespace verlet_cable

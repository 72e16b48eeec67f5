#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "../support/scenes.h"
#include "lanes/lane_stepper.h"
#include "verlet_cable/core/world_stepper.h"
#include "world/flush_denormals.h"

namespace verlet_cable {
namespace {

struct Kind {
  const char* name;
  AttachmentType attachment;
  double bending_stiffness, bending_damping, axial_stiffness;
  bool held_twice;
};

/// Of n segments; swings on a hand, and on another one.
SceneDesc swinging(const Kind& kind, int n) {
  SceneDesc scene = scenes::held_by_a_hand(n, kind.attachment);
  MaterialDesc& material = scene.materials[0].material;
  material.bending_stiffness = kind.bending_stiffness;
  material.bending_damping = kind.bending_damping;
  material.axial_stiffness = kind.axial_stiffness;
  material.axial_damping = kind.axial_stiffness < infinity ? 1 : 0;
  material.drag = 0.01;
  scene.fluid.velocity = {0.5, 2, 0};
  if (!kind.held_twice) scene.cables[0].attachments.resize(1);
  return scene;
}

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> all{
      {"chain", AttachmentType::hinge, 0, 0, infinity, true},
      {"hanging", AttachmentType::hinge, 0, 0, infinity, false},
      {"elastic", AttachmentType::hinge, 0, 0, 1e4, true},
      {"bent", AttachmentType::hinge, 0.01, 0, infinity, true},
      {"clamped", AttachmentType::clamp, 0.01, 0, infinity, true},
      {"cantilever", AttachmentType::clamp, 0.01, 0, infinity, false},
      {"elastic_clamped", AttachmentType::clamp, 0.01, 0, 1e4, true},
      {"damped", AttachmentType::clamp, 0.01, 1e-4, infinity, true},
      {"elastic_damped", AttachmentType::clamp, 0.01, 1e-4, 1e4, true},
  };
  return all;
}

double largest_difference(const std::vector<Vector3>& a, const std::vector<Vector3>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, (a[i] - b[i]).norm());
  return largest;
}

/// Where the hand of `held_by_a_hand` is.
Pose hand_at_time(double t) {
  Pose pose;
  pose.position = {0.6 + 0.05 * std::sin(5 * t), 0.03 * std::sin(7 * t), 0};
  pose.orientation = Eigen::AngleAxisd(0.3 * std::sin(4 * t), Vector3::UnitY());
  return pose;
}

class Lanes : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(Cables, Lanes, testing::ValuesIn(kinds()), [](const auto& info) { return info.param.name; });

/// One law, two programs: what CableStepper does to one cable, lanes do to it, up to the tolerance of the iteration.
TEST_P(Lanes, DoWhatCableStepperDoes) {
  for (const int n : {4, 5, 6, 7, 40, 41}) {
    const SceneDesc scene = swinging(GetParam(), n);
    BoundaryInputs inputs = initial_frames(scene);
    const bool has_hand = inputs.size() > 1;
    if (has_hand) inputs[1] = {hand_at_time(0), true, {}};
    World world(scene, inputs);
    double t = 0;
    for (int i = 1; i <= 50; ++i) {
      t += world.time_step();
      if (has_hand) inputs[1].pose = hand_at_time(t);
      world.step(inputs);
    }
    const SimulatedCable& cable = world.cables()[0];
    const double h = 1e-3;
    Boundary boundary, other_boundary;
    for (const Attachment& attachment : world.attachments()) {
      Pose next = attachment.frame == 0 ? Pose() : hand_at_time(t + h);
      next = next * attachment.pose;
      const Vector3 start = cable.state.positions[attachment.node];
      const Quaternion turned = (attachment.frame == 0 ? Pose() : hand_at_time(t)).orientation * attachment.pose.orientation;
      boundary.nodes.push_back({attachment.node, next.position, (next.position - start) / h});
      if (GetParam().attachment == AttachmentType::clamp)
        boundary.directions.push_back({attachment.node, turned, next.orientation});
    }
    other_boundary = boundary;
    const Environment environment{scene.gravity, scene.fluid, no_waves};
    std::vector<TwistSpan> spans;
    Substep substep{*cable.model, environment, boundary, spans, h};
    substep.tolerance = 1e-9;
    CableState alone = cable.state, in_lanes = cable.state;
    CableStepper stepper;
    stepper.resize(n);
    const SubstepResult expected = stepper.advance(substep, alone);
    ASSERT_TRUE(expected.converged);
    Substep other{*cable.model, environment, other_boundary, spans, h};
    other.tolerance = substep.tolerance;
    ASSERT_TRUE(fits_lanes(other, in_lanes, true));
    std::vector<LaneMember> members;
    members.push_back({other, &in_lanes, {}});
    LaneStepper lanes;
    lanes.advance(members, 2, stepper);
    ASSERT_TRUE(members[0].result.converged);

    // Velocities change by 1e-2 m/s in the substep; corrections are below 1e-12 segment lengths.
    EXPECT_LT(largest_difference(alone.positions, in_lanes.positions), 1e-12) << n;
    EXPECT_LT(largest_difference(alone.velocities, in_lanes.velocities), 1e-9) << n;
    EXPECT_LT(largest_difference(alone.accelerations, in_lanes.accelerations), 1e-6) << n;
    EXPECT_NEAR(members[0].result.max_strain, expected.max_strain, 1e-11);
    double largest = 0;
    for (const double tension : alone.tension) largest = std::max(largest, std::abs(tension));
    for (int i = 0; i < n; ++i) {
      EXPECT_NEAR(in_lanes.tension[i], alone.tension[i], 1e-6 * largest) << n << ' ' << i;
      EXPECT_NEAR(in_lanes.axial_multiplier[i], alone.axial_multiplier[i], 1e-6 * largest) << n << ' ' << i;
    }
    for (std::size_t k = 0; k < boundary.nodes.size(); ++k)
      EXPECT_LT((boundary.nodes[k].force - other_boundary.nodes[k].force).norm(), 1e-6 * largest) << n << ' ' << k;
    for (std::size_t k = 0; k < boundary.directions.size(); ++k)
      EXPECT_LT((boundary.directions[k].torque - other_boundary.directions[k].torque).norm(), 1e-6 * largest) << n << ' ' << k;
  }
}

/// Cables of all kinds and of different lengths, some more than a batch takes, one that whips.
SceneDesc crowd() {
  SceneDesc scene;
  int count = 0;
  for (const Kind& kind : kinds()) {
    for (const int n : {20, 21, 20, 20, 20, 20, 21}) {
      const SceneDesc one = swinging(kind, n);
      const std::string number = std::to_string(count++);
      scene.time_step = 0.005;
      scene.fluid = one.fluid;
      scene.materials.push_back(one.materials[0]);
      scene.materials.back().name = "material" + number;
      scene.materials.back().material.linear_density *= 1 + 0.1 * (count % 5);
      CableDesc& cable = scene.cables.emplace_back(one.cables[0]);
      cable.name = "cable" + number;
      cable.material = scene.materials.back().name;
      for (AttachmentDesc& attachment : cable.attachments) {
        attachment.name += number;
        attachment.offset.y() += 0.1 * count;
      }
    }
  }
  CableDesc& whip = scene.cables.emplace_back(scenes::released(20, M_PI / 2).cables[0]);
  whip.name = "whip";
  whip.material = scene.materials[0].name;
  return scene;
}

BoundaryInputs crowd_frames(const SceneDesc& scene, double t) {
  BoundaryInputs inputs = initial_frames(scene);
  inputs[1] = {hand_at_time(t), true, {}};
  return inputs;
}

TEST(LanesOfEveryWidth, GiveTheSameBytes) {
  const SceneDesc scene = crowd();
  const BoundaryInputs start = crowd_frames(scene, 0);
  World narrow(scene, start);
  narrow.limit_lanes(2);
  std::vector<std::unique_ptr<World>> wider;
  for (int lanes = 4; lanes <= widest_lanes(); lanes *= 2) {
    wider.push_back(std::make_unique<World>(narrow));
    wider.back()->limit_lanes(lanes);
  }
  if (wider.empty()) GTEST_SKIP() << "this processor has no lanes wider than 2";
  for (int i = 1; i <= 200; ++i) {
    const BoundaryInputs inputs = crowd_frames(scene, 0.005 * i);
    const StepResult expected = narrow.step(inputs);
    for (const auto& world : wider) {
      const StepResult result = world->step(inputs);
      ASSERT_EQ(world->hash(), narrow.hash()) << "step " << i;
      ASSERT_EQ(result.iterations, expected.iterations);
      ASSERT_EQ(result.max_strain, expected.max_strain);
      for (std::size_t k = 0; k < narrow.attachments().size(); ++k) {
        ASSERT_EQ(world->attachments()[k].force, narrow.attachments()[k].force);
        ASSERT_EQ(world->attachments()[k].torque, narrow.attachments()[k].torque);
      }
    }
  }
}

TEST(WorldStepper, TakesWorldsOfDifferentWidths) {
  const SceneDesc scene = crowd();
  std::vector<World> alone(8, World(scene, crowd_frames(scene, 0)));
  for (std::size_t i = 0; i < alone.size(); ++i) alone[i].limit_lanes(i % 2 == 0 ? 4 : 2);
  std::vector<World> together = alone;
  const BoundaryInputs inputs = crowd_frames(scene, 0.005);
  std::vector<WorldStep> steps(alone.size());
  for (std::size_t i = 0; i < alone.size(); ++i) steps[i] = {&together[i], &inputs, {}};
  WorldStepper stepper;
  for (int k = 0; k < 3; ++k) {
    stepper.step(steps, false);
    for (World& world : alone) world.step(inputs);
    for (std::size_t i = 0; i < alone.size(); ++i) ASSERT_EQ(together[i].hash(), alone[i].hash()) << i;
  }
}

/// Numbers that are not finite stay with the cable that has them: a lane's record is all its own.
TEST(LanesOfEveryWidth, LeaveNothingToTheNextCables) {
  // Where the longer one has an inner node, the shorter one has its end.
  const SceneDesc long_scene = swinging(kinds()[7], 21), scene = swinging(kinds()[7], 20);
  const World longer(long_scene, crowd_frames(long_scene, 0)), shorter(scene, crowd_frames(scene, 0));
  const SimulatedCable& cable = shorter.cables()[0];
  const Environment environment{scene.gravity, scene.fluid, no_waves};
  std::vector<TwistSpan> spans;
  CableStepper cleaner;
  LaneStepper used, fresh;
  const auto advance = [&](LaneStepper& lanes, CableState& state) {
    Boundary boundary;
    boundary.nodes.push_back({0, state.positions.front(), Vector3::Zero()});
    std::vector<LaneMember> members;
    members.push_back({Substep{*cable.model, environment, boundary, spans, 1e-3}, &state, {}});
    lanes.advance(members, 2, cleaner);
    return members[0].result.converged;
  };
  CableState broken = longer.cables()[0].state;
  for (Vector3& velocity : broken.velocities) velocity.setConstant(std::nan(""));
  EXPECT_FALSE(advance(used, broken));
  CableState state = cable.state, expected = cable.state;
  ASSERT_TRUE(advance(used, state));
  ASSERT_TRUE(advance(fresh, expected));
  for (std::size_t i = 0; i < state.positions.size(); ++i) {
    EXPECT_EQ(state.positions[i], expected.positions[i]);
    EXPECT_EQ(state.velocities[i], expected.velocities[i]);
  }
}

TEST(WorldStepper, DoesWhatEachWorldDoes) {
  const SceneDesc scene = crowd();
  SceneDesc touching = swinging(kinds()[4], 20);
  touching.time_step = scene.time_step;
  touching.contact = ContactDesc{};
  std::vector<World> alone, together;
  for (int i = 0; i < 20; ++i) {
    const SceneDesc& mine = i % 3 == 0 ? touching : scene;
    alone.emplace_back(mine, crowd_frames(mine, 0.01 * i));
  }
  together = alone;
  WorldStepper stepper;
  std::vector<BoundaryInputs> inputs(alone.size());
  std::vector<WorldStep> steps(alone.size());
  for (int k = 1; k <= 40; ++k) {
    for (std::size_t i = 0; i < alone.size(); ++i) {
      inputs[i] = crowd_frames(i % 3 == 0 ? touching : scene, 0.005 * k * (1 + 0.1 * i));
      steps[i].world = &together[i];
      steps[i].inputs = &inputs[i];
    }
    stepper.step(steps, k % 2 == 0);
    for (std::size_t i = 0; i < alone.size(); ++i) {
      const StepResult expected = alone[i].step(inputs[i]);
      ASSERT_EQ(together[i].hash(), alone[i].hash()) << "world " << i << ", step " << k;
      ASSERT_EQ(steps[i].result.status, expected.status);
      ASSERT_EQ(steps[i].result.iterations, expected.iterations);
      ASSERT_EQ(steps[i].result.max_strain, expected.max_strain);
    }
  }
}

TEST(FlushDenormals, HoldsAsLongAsItLives) {
  const volatile double small = 1e-300, scale = 1e-15;
  {
    const FlushDenormals flush_denormals;
    const FlushDenormals nested;
    EXPECT_EQ(small * scale, 0);
  }
  EXPECT_GT(small * scale, 0);
}

TEST(FlushDenormals, AWorldLeavesTheCallersModeAsItWas) {
  const volatile double small = 1e-300, scale = 1e-15;
  const SceneDesc scene = crowd();
  World world(scene, crowd_frames(scene, 0));
  world.settle();
  world.step(crowd_frames(scene, 0.005));
  EXPECT_GT(small * scale, 0);
}

}  // namespace
}  // namespace verlet_cable

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "../support/nets.h"

namespace verlet_cable {
namespace {

using Status = StepResult::Status;

/// 10 g in a row along x; its first node is held in the origin.
SceneDesc row(LinkType type, int nodes, double spacing, double time_step) {
  SceneDesc scene;
  scene.time_step = time_step;
  NetDesc net = scenes::grid(1, nodes, spacing, type);
  net.mass = 0.01;
  net.stiffness = 500;
  net.damping = 0.5;
  net.tolerance = 0.1;
  net.attachments = {scenes::net_attachment("holder", 0, {0, 0, 0})};
  scene.nets = {net};
  return scene;
}

/// What was seen of a world's first net.
struct Seen {
  std::map<Status, int> steps;
  double force = 0;    ///< [N] on a holder
  double tension = 0;  ///< [N]
  double energy = 0;   ///< [J] of motion and height, above that at the start
};

void watch(World& world, const BoundaryInputs& inputs, int steps, Seen& seen) {
  const Energy start = world.energy();
  for (int i = 0; i < steps; ++i) {
    ++seen.steps[world.step(inputs).status];
    for (const Attachment& attachment : world.attachments()) seen.force = std::max(seen.force, attachment.force.norm());
    for (const double tension : world.nets()[0].state.tension) seen.tension = std::max(seen.tension, std::abs(tension));
    const Energy now = world.energy();
    seen.energy = std::max(seen.energy, now.kinetic + now.gravity - start.kinetic - start.gravity);
  }
}

struct Fall {
  LinkType type;
  int nodes;
  double spacing, time_step;
};

TEST(TurningLinks, ChainThatFallsFromTheHorizontalCreatesNoEnergy) {
  for (const Fall& fall : {Fall{LinkType::rigid, 8, 0.01, 5e-3}, Fall{LinkType::rigid, 13, 0.05, 1e-2},
                           Fall{LinkType::rigid, 30, 0.2, 1e-2}, Fall{LinkType::limited, 8, 0.05, 1e-2}}) {
    const SceneDesc scene = row(fall.type, fall.nodes, fall.spacing, fall.time_step);
    World world(scene, initial_frames(scene));
    const int steps = static_cast<int>(5 / fall.time_step);
    Seen seen;
    watch(world, initial_frames(scene), steps, seen);
    const double weight = 0.01 * 9.81, length = (fall.nodes - 1) * fall.spacing;
    const std::string which = std::to_string(fall.nodes) + " nodes, " + std::to_string(fall.spacing) + " m";
    EXPECT_EQ(seen.steps[Status::ok], steps) << which;
    EXPECT_LT(seen.energy, (fall.type == LinkType::rigid ? 0.05 : 0.5) * weight * length) << which;
    EXPECT_LT(seen.force, 30 * weight) << which;
    EXPECT_LT(seen.tension, 30 * weight) << which;
  }
}

TEST(TurningLinks, MassThatWhirlsByTwoRadiansAStepPullsAsItsCentripetalForce) {
  SceneDesc scene = row(LinkType::rigid, 2, 0.01, 5e-3);
  scene.gravity.acceleration.setZero();
  scene.nets[0].velocity = {0, 0, 4};
  World world(scene, initial_frames(scene));
  const double expected = 0.005 * 4 * 4 / 0.01;
  double sum = 0;
  const int steps = 200;
  for (int i = 0; i < steps; ++i) {
    ASSERT_EQ(world.step(initial_frames(scene)).status, Status::ok) << i;
    // Velocities at the end of a step go on from those in its parts, which turn by up to 30 degrees.
    EXPECT_NEAR(world.nets()[0].state.velocities[1].norm(), 4, 0.6) << i;
    sum += world.nets()[0].state.tension[0];
  }
  EXPECT_NEAR(sum / steps, expected, 0.1 * expected);
}

TEST(TurningLinks, GridThatOneNodeHoldsIsNotOverstretched) {
  SceneDesc scene;
  NetDesc net = scenes::grid(5, 5, 0.1, LinkType::rigid);
  net.grid->y_axis = {0, 1, 0};
  net.mass = 0.05;
  net.attachments = {scenes::net_attachment("corner", 0, {0, 0, 0})};
  scene.nets = {net};
  World world(scene, initial_frames(scene));
  for (int i = 0; i < 1000; ++i) {
    const StepResult result = world.step(initial_frames(scene));
    ASSERT_EQ(result.status, Status::ok) << i;
    ASSERT_LT(result.max_strain, 1.1e-3) << i;
  }
}

/// A row of three with a second holder, which moves by `way` in so many steps, stays, comes back at once, and stays.
Seen move_and_return(LinkType type, int second_node, double way, int steps, Seen& away) {
  SceneDesc scene = row(type, 3, 0.01, 5e-3);
  scene.nets[0].attachments.push_back(scenes::net_attachment("hand", second_node, {0.01 * second_node, 0, 0}));
  scene.nets[0].attachments.back().frame = "hand";
  BoundaryInputs inputs(2);
  World world(scene, inputs);
  for (int i = 1; i <= steps; ++i) {
    inputs[1].pose.position.x() = way * i / steps;
    watch(world, inputs, 1, away);
  }
  watch(world, inputs, 230, away);
  inputs[1].pose.position.x() = 0;
  watch(world, inputs, 4, away);
  Seen after;
  watch(world, inputs, 250, after);
  return after;
}

TEST(TurningLinks, RowThatIsFoldedAndOpenedAgainStaysBounded) {
  for (const auto& [type, way] : {std::pair{LinkType::rigid, -0.02}, {LinkType::limited, -0.01}}) {
    Seen away;
    const Seen after = move_and_return(type, 2, way, 4, away);
    // 10 g that are moved by 1 cm within a sixteenth of a step of 5 ms: 1 kN.
    EXPECT_LT(std::max(away.force, after.force), 1000);
    EXPECT_LT(std::max(away.tension, after.tension), 1000);
    EXPECT_LT(after.energy, 0.1);
  }
}

TEST(TurningLinks, LinkThatIsHeldTooLongAtBothEndsIsToldAsOverstretched) {
  Seen away;
  Seen after = move_and_return(LinkType::rigid, 1, 0.02, 40, away);
  EXPECT_GE(away.steps[Status::overstretched], 230);
  EXPECT_EQ(after.steps[Status::overstretched], 0);
  EXPECT_LT(std::max(away.force, after.force), 100);
  EXPECT_LT(std::max(away.tension, after.tension), 100);
}

}  // namespace
}  // namespace verlet_cable

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "../support/scenes.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {
namespace {

CableDesc straight(const std::string& name, const Vector3& from, const Vector3& to, int segments) {
  CableDesc cable;
  cable.name = name;
  cable.material = "rope";
  cable.segments = segments;
  cable.length = (to - from).norm();
  cable.initial.type = InitialShapeDesc::Type::straight;
  cable.initial.from = from;
  cable.initial.to = to;
  return cable;
}

/// A cable that falls on a floor, bounces and piles up.
SceneDesc falling_cable() {
  SceneDesc scene = scenes::one_cable(40);
  scene.materials[0].material.bending_stiffness = 1e-3;
  scene.contact = ContactDesc{};
  scene.cables[0] = straight("cable", {0, 0, 0.1}, {1, 1, 0.4}, 60);
  ObstacleDesc floor;
  floor.name = "floor";
  floor.type = ShapeType::plane;
  scene.obstacles.push_back(floor);
  return scene;
}

TEST(Islands, CableThatIsNowhereNearChangesNoByteOfAnother) {
  const SceneDesc alone = falling_cable();
  // Far away, and in a corner of the box around the first one; both fall on something.
  for (const Vector3& start : {Vector3(20, 0, 0.3), Vector3(0.75, 0.1, 0.3)}) {
    SceneDesc accompanied = alone;
    accompanied.cables.push_back(straight("other", start, start + Vector3(0.05, 0.15, 0.2), 30));
    World world(alone, BoundaryInputs(1)), other_world(accompanied, BoundaryInputs(1));
    for (int i = 0; i < 1000; ++i) {
      world.step(BoundaryInputs(1));
      other_world.step(BoundaryInputs(1));
      const CableState &state = world.cables()[0].state, &other = other_world.cables()[0].state;
      ASSERT_EQ(state.positions, other.positions) << "step " << i;
      ASSERT_EQ(state.velocities, other.velocities) << "step " << i;
      ASSERT_EQ(state.tension, other.tension) << "step " << i;
    }
  }
}

TEST(Islands, BraidWithoutRoomEndsDegradedAndWithBoundedForces) {
  SceneDesc scene = scenes::one_cable(40);
  scene.materials[0].material.radius = 0.01;
  scene.contact = ContactDesc{};
  scene.cables.clear();
  for (int k = 0; k < 3; ++k) {
    CableDesc cable = straight("cable" + std::to_string(k), {0, 0, 0}, {1, 0, 0}, 40);
    cable.initial.type = InitialShapeDesc::Type::points;
    std::vector<Vector3>& points = cable.initial.points;
    cable.length = 0;
    for (int i = 0; i <= 400; ++i) {
      const double angle = 2 * M_PI * (5.0 * i / 400 + k / 3.0);
      points.emplace_back(i / 400.0, 0.005 * std::cos(angle), 0.005 * std::sin(angle));
      if (i > 0) cable.length += (points[i] - points[i - 1]).norm();
    }
    cable.attachments = {scenes::attachment(cable.name + "_start", PlaceDesc::At::start, points.front()),
                         scenes::attachment(cable.name + "_end", PlaceDesc::At::end, points.back())};
    scene.cables.push_back(cable);
  }
  World world(scene, BoundaryInputs(1));
  int degraded = 0;
  for (int i = 0; i < 50; ++i) {
    const StepResult result = world.step(BoundaryInputs(1));
    degraded += result.status == StepResult::Status::degraded ? 1 : 0;
    EXPECT_EQ(result.substeps, 1);
    // The law of contacts that cables have pressed into would come to 40 kN.
    for (const Attachment& attachment : world.attachments()) EXPECT_LT(attachment.force.norm(), 2e3);
  }
  EXPECT_GE(degraded, 45);
}

}  // namespace
}  // namespace verlet_cable

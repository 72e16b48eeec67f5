#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "../support/scenes.h"
#include "body/hanging_places.h"
#include "verlet_cable/core/rotation.h"

// Where bodies without a pose, and junctions, hang on several cables.

namespace verlet_cable {
namespace {

/// [m] What cannot stretch yields by 1e-7 of its length where it carries all weight; these carry up to twice that.
constexpr double yields = 1e-6;
const Vector3 down = -Vector3::UnitZ();

/// A rope without weight, of one link, from a place that stays.
HangingSpan rope(const Vector3& from, double length, const Vector3& point, int body = 0) {
  HangingSpan span;
  span.ends[0].point = from;
  span.ends[1].body = body;
  span.ends[1].point = point;
  span.lengths = {length};
  span.compliances = {0};
  return span;
}

Vector3 end_of(const HangingSpan& span, const std::vector<HangingBody>& bodies) {
  return span.ends[0].point + chord(span, bodies);
}

/// The same ropes with each place turned.
std::vector<HangingSpan> turned(std::vector<HangingSpan> spans, const Quaternion& rotation) {
  for (HangingSpan& span : spans)
    for (HangingEnd& end : span.ends)
      if (end.body < 0) end.point = rotation * end.point;
  return spans;
}

/// Ropes of l from points that are D apart to the ends of a bar of 2 a: each is the hypotenuse above (D - 2 a) / 2.
TEST(HangingPlaces, aBarOnTwoEqualRopesHangsLevel) {
  const double distance = 1.5, length = 0.9, half = 0.4;
  const std::vector<HangingSpan> spans{rope({0, 0, 2}, length, {-half, 0, 0}), rope({distance, 0, 2}, length, {half, 0, 0})};
  std::vector<HangingBody> bodies{{Pose{}, Vector3::Zero(), 10}};
  find_hanging_places(spans, down, bodies);
  const double depth = std::sqrt(length * length - std::pow(0.5 * distance - half, 2));
  EXPECT_LT((bodies[0].pose.position - Vector3(0.5 * distance, 0, 2 - depth)).norm(), yields);
  EXPECT_LT((end_of(spans[0], bodies) - Vector3(0.5 * distance - half, 0, 2 - depth)).norm(), yields);
}

/// Of the two places in which the forces on a bar balance, its weight is above its ropes' ends in one, which does not last.
TEST(HangingPlaces, aBodyThatBeginsUpsideDownTurnsOver) {
  const std::vector<HangingSpan> spans{rope({0, 0, 2}, 1, {-0.5, 0, 0}), rope({1, 0, 2}, 1, {0.5, 0, 0})};
  std::vector<HangingBody> bodies{{Pose{}, {0, 0, 0.2}, 10}};
  find_hanging_places(spans, down, bodies);
  EXPECT_LT((bodies[0].pose * Pose{{0, 0, 0.2}, Quaternion::Identity()}).position.z(), 1 - 0.2 + yields);
}

/// A body on two ropes is at rest where the ropes and the line of its weight meet in a point, and each rope is as long as it is.
TEST(HangingPlaces, aBarOnUnequalRopesHangsWhereTheirLinesMeet) {
  const std::vector<HangingSpan> spans{rope({0, 0, 2}, 0.7, {-0.5, 0, 0}), rope({1.2, 0, 2.3}, 1.1, {0.5, 0, 0})};
  const auto hang = [&](const Quaternion& rotation) {
    std::vector<HangingBody> bodies{{Pose{}, {0.1, 0, -0.05}, 10}};
    find_hanging_places(turned(spans, rotation), rotation * down, bodies);
    return bodies;
  };
  const std::vector<HangingBody> bodies = hang(Quaternion::Identity());
  for (const HangingSpan& span : spans) EXPECT_NEAR(chord(span, bodies).norm(), span.lengths[0], yields);
  const Vector3 center = (bodies[0].pose * Pose{bodies[0].center, Quaternion::Identity()}).position;
  // Heights above the weight at which the ropes' lines pass over it.
  double heights[2];
  for (const int k : {0, 1}) {
    const Vector3 way = chord(spans[k], bodies);
    heights[k] = end_of(spans[k], bodies).z() + (center.x() - end_of(spans[k], bodies).x()) / way.x() * way.z();
    EXPECT_NEAR(way.y(), 0, yields);
  }
  // A line is off by what its rope's end is, over the rope's slope.
  EXPECT_NEAR(heights[0], heights[1], 1e-4);

  // Gravity has no direction of its own.
  const Quaternion rotation = quaternion_from_rpy({0.4, -1.1, 2});
  const std::vector<HangingBody> others = hang(rotation);
  for (const Vector3& point : {Vector3(-0.5, 0, 0), Vector3(0.5, 0, 0), Vector3(0, 0, -1)}) {
    const Pose in_body{point, Quaternion::Identity()};
    EXPECT_LT(((others[0].pose * in_body).position - rotation * (bodies[0].pose * in_body).position).norm(), 1e-5);
  }
}

/// Points R from the middle of a ring hold what hangs on ropes of l below it by sqrt(l^2 - R^2).
TEST(HangingPlaces, threeRopesHoldAPoint) {
  const double radius = 0.6, length = 1;
  std::vector<HangingSpan> spans;
  for (int k = 0; k < 3; ++k) {
    const double angle = 2 * M_PI * k / 3;
    spans.push_back(rope({radius * std::cos(angle), radius * std::sin(angle), 0}, length, Vector3::Zero()));
  }
  std::vector<HangingBody> bodies{{Pose{{0, 0, -1}, Quaternion::Identity()}, Vector3::Zero(), 5, false}};
  find_hanging_places(spans, down, bodies);
  EXPECT_LT((bodies[0].pose.position - Vector3(0, 0, -std::sqrt(length * length - radius * radius))).norm(), yields);
}

/// Two ropes of unlike lengths that meet: the corner of a triangle.
TEST(HangingPlaces, twoRopesMeetInATriangle) {
  const double first = 0.8, second = 0.7, distance = 1;
  const std::vector<HangingSpan> spans{rope({0, 0, 0}, first, Vector3::Zero()), rope({distance, 0, 0}, second, Vector3::Zero())};
  std::vector<HangingBody> bodies{{Pose{{0, 0, -1}, Quaternion::Identity()}, Vector3::Zero(), 5, false}};
  find_hanging_places(spans, down, bodies);
  const double x = (first * first - second * second + distance * distance) / (2 * distance);
  EXPECT_LT((bodies[0].pose.position - Vector3(x, 0, -std::sqrt(first * first - x * x))).norm(), yields);
}

/// A chain of heavy links is the same whether a node of it is a junction or not: link i has the slope V_i / H, of the weights
/// below it to one side, V_i, and of one horizontal force H, with which all links are as wide as the chain hangs.
TEST(HangingPlaces, aJunctionInAChainIsANodeOfIt) {
  const int links = 20, left = 7;
  const double length = 0.1, weight = 0.5, width = 1.5;
  const auto node = [&](double force, int n) {
    Vector3 place = Vector3::Zero();
    for (int i = 0; i < n; ++i) {
      const double vertical = weight * (0.5 * (links - 1) - i);
      place += length / std::hypot(force, vertical) * Vector3(force, 0, -vertical);
    }
    return place;
  };
  double low = 0, high = 100;
  for (int i = 0; i < 100; ++i) (node(0.5 * (low + high), links).x() < width ? low : high) = 0.5 * (low + high);

  std::vector<HangingSpan> spans{rope({0, 0, 0}, length, Vector3::Zero()), rope({width, 0, 0}, length, Vector3::Zero())};
  for (const int k : {0, 1}) {
    const int n = k == 0 ? left : links - left;
    spans[k].lengths.assign(n, length);
    spans[k].compliances.assign(n, 0);
    spans[k].weights.assign(n - 1, weight);
  }
  std::vector<HangingBody> bodies{{Pose{{0.5, 0, -1}, Quaternion::Identity()}, Vector3::Zero(), weight, false}};
  find_hanging_places(spans, down, bodies);
  // Links that bear 1e-4 of their chain's weight would be rounded; these bear half of it.
  EXPECT_LT((bodies[0].pose.position - node(low, left)).norm(), yields);
}

/// Clamps that pull much more than the weight turn spans, and do not stretch them: straight on from the clamps, the ropes would
/// leave the ends of a bar of 0.1 m too far apart.
TEST(HangingPlaces, stiffClampsDoNotStretch) {
  std::vector<HangingSpan> spans{rope({0, 0, 0}, 0.5, {-0.05, 0, 0}), rope({1, 0, 0}, 0.5, {0.05, 0, 0})};
  for (const int k : {0, 1}) {
    spans[k].ends[0].axis = Vector3(k == 0 ? -1 : 1, 0, 0);
    spans[k].ends[0].stiffness = 100;
  }
  std::vector<HangingBody> bodies{{Pose{{0.5, 0, -0.4}, Quaternion::Identity()}, Vector3::Zero(), 1e-3}};
  find_hanging_places(spans, down, bodies);
  for (const HangingSpan& span : spans) EXPECT_LT(chord(span, bodies).norm(), 0.5 * (1 + yields));
}

/// Two ropes side by side share a weight: each is strained by half of it, up to what a start may be strained.
TEST(HangingPlaces, softRopesStretchAsFarAsAStartMay) {
  for (const auto& [compliance, strain] : {std::pair{1e-3, 5e-3}, {1e-2, largest_start_strain}}) {
    std::vector<HangingSpan> spans{rope({-0.1, 0, 0}, 1, {-0.1, 0, 0}), rope({0.1, 0, 0}, 1, {0.1, 0, 0})};
    for (HangingSpan& span : spans) span.compliances = {compliance};
    std::vector<HangingBody> bodies{{Pose{{0, 0, -1}, Quaternion::Identity()}, Vector3::Zero(), 10}};
    find_hanging_places(spans, down, bodies);
    EXPECT_LT((bodies[0].pose.position - Vector3(0, 0, -1 - strain)).norm(), yields);
  }
}

/// A bar without pose on two ropes from frames that are 1.5 m apart, one of them higher.
SceneDesc bar_on_ropes(double length, double axial_stiffness) {
  SceneDesc scene = scenes::one_cable(15, length);
  scene.time_step = 0.002;
  scene.materials[0].material.linear_density = 0.02;
  scene.materials[0].material.axial_stiffness = axial_stiffness;
  if (std::isfinite(axial_stiffness)) scene.materials[0].material.axial_damping = 20;
  scene.cables.push_back(scene.cables[0]);
  BodyDesc& bar = scene.bodies.emplace_back();
  bar.name = "bar";
  bar.mass = 1.2;
  bar.inertia = Vector3(1e-3, 0.2, 0.2);
  for (const int k : {0, 1}) {
    CableDesc& cable = scene.cables[k];
    const std::string name = k == 0 ? "left" : "right";
    cable.name = name;
    cable.attachments = {scenes::attachment(name + "_hand", PlaceDesc::At::start, Vector3::Zero(), "hand_" + name),
                         scenes::attachment(name + "_end", PlaceDesc::At::end, {k == 0 ? -0.7 : 0.7, 0, 0.02})};
    cable.attachments[0].initial_pose = InitialPose{k == 0 ? 0.0 : 1.5, 0, k == 0 ? 2.0 : 2.3, 0, 0, 0};
    cable.attachments[1].body = "bar";
  }
  return scene;
}

double kinetic_after(World& world, const BoundaryInputs& inputs, int steps) {
  for (int i = 0; i < steps; ++i) world.step(inputs);
  return world.energy().kinetic;
}

/// It hangs at rest from the first step on. Inextensible ropes start within 1e-3 of their lengths, and the bar falls by no more
/// than that, a height h of which is worth m g h; elastic ones start with the strain that they have there.
TEST(HangingPlaces, aBarWithoutPoseStartsAtRest) {
  for (const double stiffness : {infinity, 2e4}) {
    const SceneDesc scene = bar_on_ropes(0.9, stiffness);
    World world(scene, initial_frames(scene));
    ASSERT_EQ(world.bodies().size(), 1u);
    EXPECT_TRUE(world.findings().unreached.empty());
    const Vector3 start = world.bodies()[0].pose.position;
    EXPECT_LT(kinetic_after(world, initial_frames(scene), 200), 1.2 * 9.81 * 0.9 * 1e-3);
    EXPECT_LT((world.bodies()[0].pose.position - start).norm(), 5e-3);
  }
}

/// What no place can reach is an error that names cable, body and distance; where frames are known later, a finding.
TEST(HangingPlaces, aStartOutOfReachIsAnErrorThatNamesCableAndBody) {
  for (const double stiffness : {infinity, 2e4}) {
    SceneDesc scene = bar_on_ropes(0.9, stiffness);
    scene.cables[1].attachments[0].initial_pose = InitialPose{4.5, 0, 2.3, 0, 0, 0};
    const std::vector<std::string> errors = validate(scene);
    ASSERT_FALSE(errors.empty());
    for (const std::string& line : errors) {
      EXPECT_EQ(line.find("cables["), 0u) << line;
      EXPECT_NE(line.find("].length: 0.9 m of cable \""), std::string::npos) << line;
      EXPECT_NE(line.find("on body \"bar\"; allowed: at least"), std::string::npos) << line;
    }
    EXPECT_THROW(World(scene, initial_frames(scene)), SceneError);

    const BoundaryInputs frames = initial_frames(scene);
    for (CableDesc& cable : scene.cables) cable.attachments[0].initial_pose.reset();
    EXPECT_TRUE(validate(scene).empty());
    EXPECT_EQ(validate_distances(scene, frames), errors);
    EXPECT_EQ(World(scene, frames).findings().unreached, errors);
  }
}

/// Ropes of 0.4 m from three corners of a triangle meet in a junction, or do not.
TEST(HangingPlaces, junctionsStartWhereTheyReachOrAreErrors) {
  for (const double radius : {0.3, 0.6}) {
    SceneDesc scene = scenes::one_cable(8, 0.4);
    scene.materials[0].material.linear_density = 0.02;
    JunctionDesc& junction = scene.junctions.emplace_back();
    junction.name = "knot";
    junction.type = JunctionDesc::Type::hinge;
    junction.place.at = PlaceDesc::At::end;
    scene.cables.resize(3, scene.cables[0]);
    for (int k = 0; k < 3; ++k) {
      const double angle = 2 * M_PI * k / 3;
      CableDesc& cable = scene.cables[k];
      cable.name = "leg" + std::to_string(k);
      cable.attachments = {scenes::attachment("corner" + std::to_string(k), PlaceDesc::At::start,
                                              {radius * std::cos(angle), radius * std::sin(angle), 1})};
      if (k == 0) {
        junction.cable = cable.name;
        continue;
      }
      BranchDesc& branch = junction.branches.emplace_back();
      branch.cable = cable.name;
      branch.end = BranchDesc::End::end;
    }
    const std::vector<std::string> errors = validate(scene);
    EXPECT_EQ(errors.empty(), radius < 0.4);
    for (const std::string& line : errors) EXPECT_NE(line.find("and junction \"knot\"; allowed:"), std::string::npos) << line;
    if (!errors.empty()) continue;
    World world(scene, initial_frames(scene));
    for (const SimulatedCable& cable : world.cables())
      for (int i = 0; i < cable.state.segments(); ++i)
        EXPECT_NEAR((cable.state.positions[i + 1] - cable.state.positions[i]).norm(), cable.state.rest_lengths[i], 5e-5);
    // By symmetry the knot is above the middle.
    EXPECT_LT(world.cables()[0].state.positions.back().head<2>().norm(), 1e-4);
  }
}

/// A load that starts straight below its rope's anchor, nearer than the rope is long: the bight carries nothing.
TEST(HangingPlaces, ALoadOnASlackRopeFalls) {
  for (const double axial_stiffness : {infinity, 1e5})
    for (const double slack : {0.07, 0.1, 0.6}) {
      SceneDesc scene = scenes::one_cable(40, 2);
      scene.materials[0].material.axial_stiffness = axial_stiffness;
      scene.cables[0].attachments = {scenes::attachment("anchor", PlaceDesc::At::start, {0, 0, 0}),
                                     scenes::attachment("hook", PlaceDesc::At::end, {0, 0, 0})};
      scene.cables[0].attachments[1].body = "load";
      BodyDesc& load = scene.bodies.emplace_back();
      load.name = "load";
      load.mass = 5;
      load.inertia = Vector3::Constant(0.03);
      load.pose = InitialPose{0, 0, slack - 2, 0, 0, 0};
      World world(scene, initial_frames(scene));
      const double end = 0.9 * std::sqrt(2 * slack / 9.81);
      while (world.time() < end) ASSERT_EQ(world.step(initial_frames(scene)).status, StepResult::Status::ok) << world.time();
      const double fallen = slack - 2 - world.bodies()[0].pose.position.z(), free = 0.5 * 9.81 * world.time() * world.time();
      // The rope weighs a fiftieth of the load, and falls with it in part.
      EXPECT_NEAR(fallen, free, 0.02 * free) << axial_stiffness << ' ' << slack;
    }
}

}  // namespace
}  // namespace verlet_cable

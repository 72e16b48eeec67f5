#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "../support/scenes.h"

namespace verlet_cable {
namespace {

using Status = StepResult::Status;

GuideDesc guide(const std::string& name, double at, const Vector3& offset) {
  GuideDesc desc;
  desc.name = name;
  desc.cable = "cable";
  desc.place = PlaceDesc{PlaceDesc::At::arc_length, at};
  desc.offset = offset;
  return desc;
}

void run(World& world, double duration) {
  const int steps = static_cast<int>(std::lround(duration / world.time_step()));
  for (int i = 0; i < steps; ++i) ASSERT_EQ(world.step({}).status, Status::ok) << "at " << world.time() << " s";
}

/// A crane: from a winch up to a sheave, along to another, and down to a load.
SceneDesc crane(bool load_is_clamped) {
  SceneDesc scene = scenes::one_cable(90, 3.6);
  scene.materials[0].material.linear_density = 0.05;
  if (load_is_clamped) {
    scene.materials[0].material.bending_stiffness = 1e-3;
    scene.materials[0].material.torsional_stiffness = 1e-3;
  }
  BodyDesc& load = scene.bodies.emplace_back();
  load.name = "load";
  load.mass = 2;
  load.inertia = Vector3::Constant(2e-3);
  CableDesc& cable = scene.cables[0];
  cable.attachments = {scenes::attachment("winch", PlaceDesc::At::start, Vector3::Zero()),
                       scenes::attachment("hook", PlaceDesc::At::end, {0, 0, 0.05}, "",
                                          load_is_clamped ? AttachmentType::clamp : AttachmentType::hinge)};
  cable.attachments[1].body = "load";
  // The cable's +x goes into the load.
  if (load_is_clamped) cable.attachments[1].rotation = {0, 0.5 * M_PI, 0};
  cable.initial.type = InitialShapeDesc::Type::points;
  cable.initial.points = {{0, 0, 0}, {0, 0, 1.5}, {1, 0, 1.5}, {1, 0, 0.4}};
  load.pose = InitialPose{1, 0, 0.35, 0, 0, 0};
  scene.guides = {guide("back", 1.5, {0.05, 0, 1.45}), guide("front", 2.5, {0.95, 0, 1.45})};
  for (GuideDesc& wheel : scene.guides) {
    wheel.type = GuideDesc::Type::sheave;
    wheel.rotation = {0.5 * M_PI, 0, 0};
    wheel.radius = 0.05;
    wheel.inertia = 1e-5;
  }
  return scene;
}

TEST(GuidedWinch, liftsABodyBehindSheaves) {
  World world(crane(false), {});
  run(world, 1);
  const double start = world.bodies()[0].pose.position.z(), length = world.cables()[0].state.length();
  ASSERT_TRUE(world.apply(edit::SetLength{0, false, length - 0.6, 0.5}).ok);
  run(world, 3);
  EXPECT_NEAR(world.cables()[0].state.length(), length - 0.6, 1e-3);
  EXPECT_NEAR(world.bodies()[0].pose.position.z() - start, 0.6, 0.02);
  EXPECT_NEAR(world.view_guide(0).arc_length, 1.5, 0.05);
  // It bounces on a rope that does not stretch: in the mean that carries it, and what hangs of the rope itself.
  double tension = 0;
  constexpr int steps = 1000;
  for (int i = 0; i < steps; ++i) {
    run(world, world.time_step());
    tension += world.view_guide(1).tension[1] / steps;
  }
  const double hanging = world.cables()[0].state.length() - world.view_guide(1).arc_length;
  EXPECT_NEAR(tension, 9.81 * (2 + 0.05 * hanging), 0.03 * 9.81 * 2);
}

/// The wheel is held by both nodes of the segment that goes: it must not look for the second one in the first piece, which no
/// number shows, but AddressSanitizer.
TEST(GuidedWinch, aWheelLetsGoOfACableThatIsCutOnIt) {
  World world(crane(false), {});
  run(world, 0.1);
  const Attachment wheel = world.attachments()[find(world.attachments(), "front")];
  const std::vector<Vector3> before = world.cables()[0].state.positions;
  ASSERT_TRUE(is_wheel(wheel));
  ASSERT_TRUE(world.apply(edit::Cut{cable_id(0), wheel.node}).ok);
  EXPECT_EQ(world.view_guide(0).cable, 0);
  EXPECT_EQ(world.view_guide(1).cable, -1);
  ASSERT_EQ(world.cables().size(), 2u);
  std::vector<Vector3> after = world.cables()[0].state.positions;
  const std::vector<Vector3>& second = world.cables()[1].state.positions;
  after.insert(after.end(), second.begin(), second.end());
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t i = 0; i < after.size(); ++i) EXPECT_LT((after[i] - before[i]).norm(), 0.05) << i;
}

/// From a winch through an eyelet a segment away, behind which the cable hangs down.
SceneDesc fairlead(double eyelet) {
  SceneDesc scene = scenes::one_cable(20, 2);
  scene.cables[0].attachments = {scenes::attachment("winch", PlaceDesc::At::start, Vector3::Zero())};
  scene.cables[0].initial.type = InitialShapeDesc::Type::points;
  scene.cables[0].initial.points = {{0, 0, 0}, {eyelet, 0, 0}, {eyelet, 0, eyelet - 2}};
  scene.guides = {guide("eye", eyelet, {eyelet, 0, 0})};
  return scene;
}

TEST(GuidedWinch, windsThroughAnEyeletBesideIt) {
  for (const double eyelet : {0.2, 0.3})
    for (const double goal : {1.5, 2.5}) {
      World world(fairlead(eyelet), {});
      ASSERT_TRUE(world.apply(edit::SetLength{0, false, goal, 0.4}).ok);
      const CableState& cable = world.cables()[0].state;
      for (int i = 0; i < 3000; ++i) {
        world.step({});
        const double mass = std::accumulate(cable.masses.begin(), cable.masses.end(), 0.0);
        // But for what the bend in the eyelet has lost of its length.
        ASSERT_NEAR(mass, 0.1 * cable.length(), 3e-3) << eyelet << " m, to " << goal << " m, at " << world.time() << " s";
        ASSERT_GT(*std::min_element(cable.rest_lengths.begin(), cable.rest_lengths.end()), 0);
      }
      EXPECT_NEAR(cable.length(), goal, 5e-3) << eyelet;
      EXPECT_EQ(world.view_guide(0).cable, 0);
    }
}

TEST(GuidedWinch, stallsWhereAnEyeletLetsNothingThrough) {
  SceneDesc scene = fairlead(0.2);
  scene.guides[0].friction = infinity;
  World world(scene, {});
  const double length = world.cables()[0].state.length();
  ASSERT_TRUE(world.apply(edit::SetLength{0, false, length - 1, 0.4}).ok);
  for (int i = 0; i < 1000; ++i) {
    world.step({});
    ASSERT_GT(world.cables()[0].state.rest_lengths[0], 0.009) << world.time() << " s";
  }
  EXPECT_GT(world.cables()[0].state.length(), length - 0.2);
}

/// From where it hangs down freely up to a sheave, and along to a winch at its end, a segment and a half away.
SceneDesc hoist() {
  SceneDesc scene = scenes::one_cable(20, 2);
  scene.cables[0].attachments = {scenes::attachment("winch", PlaceDesc::At::end, {0.2, 0, 0.05})};
  scene.cables[0].initial.type = InitialShapeDesc::Type::points;
  scene.cables[0].initial.points = {{0, 0, -1.75}, {0, 0, 0.05}, {0.2, 0, 0.05}};
  GuideDesc& wheel = scene.guides.emplace_back(guide("wheel", 1.8, {0.05, 0, 0}));
  wheel.frame = "hand";
  wheel.type = GuideDesc::Type::sheave;
  wheel.rotation = {0.5 * M_PI, 0, 0};
  wheel.radius = 0.05;
  wheel.inertia = 1e-5;
  return scene;
}

TEST(GuidedWinch, atTheEndOfACableLeavesTheSheaveBesideItBothOfItsNodes) {
  World world(hoist(), scenes::hand_at(Vector3::Zero()));
  ASSERT_TRUE(world.apply(edit::SetLength{0, true, 1.2, 0.4}).ok);
  const CableState& cable = world.cables()[0].state;
  for (int i = 0; i < 3000; ++i) {
    // The sheave comes close to the winch.
    world.step(scenes::hand_at({std::min(0.1 * world.time(), 0.12), 0, 0}));
    const Attachment& wheel = world.attachments()[world.attachments()[0].guide == 0 ? 0 : 1];
    ASSERT_LT(wheel.node + 1, cable.segments()) << world.time() << " s";
    const double mass = std::accumulate(cable.masses.begin(), cable.masses.end(), 0.0);
    // But for what bends beside the wheel have lost of its length.
    ASSERT_NEAR(mass, 0.1 * cable.length(), 5e-3) << world.time() << " s";
  }
  EXPECT_NEAR(cable.length(), 1.2, 5e-3);
  EXPECT_EQ(world.view_guide(0).cable, 0);
}

/// The step is planned when the places where the cable comes to the wheel and leaves it follow what is beside it.
TEST(GuidedWinch, keepsTheMassThatComesOntoTheSheaveBesideIt) {
  World world(hoist(), scenes::hand_at(Vector3::Zero()));
  constexpr double speed = 0.01, density = 0.1;
  ASSERT_TRUE(world.apply(edit::SetLength{0, true, 2.2, speed}).ok);
  const std::vector<double>& masses = world.cables()[0].state.masses;
  const auto mass = [&] { return std::accumulate(masses.begin(), masses.end(), 0.0); };
  for (int i = 0; i < 100; ++i) {
    const double before = mass();
    world.step(scenes::hand_at({0, 0, (i + 1) * world.time_step()}));  // at 1 m/s
    ASSERT_LE(std::abs(mass() - before), 2 * speed * world.time_step() * density) << world.time() << " s";
  }
}

TEST(GuidedWinch, aRodRunsOverOneSheaveOnly) {
  try {
    World world(crane(true), {});
    FAIL();
  } catch (const SceneError& error) {
    ASSERT_EQ(error.errors().size(), 1u);
    EXPECT_EQ(error.errors()[0].find("guides[1].cable: \"cable\"; allowed: a cable that no other sheave holds, as \"back\" does"),
              0u)
        << error.errors()[0];
  }
}

TEST(GuidedCables, areCutBetweenTheirGuides) {
  SceneDesc scene = scenes::between_two_points(60, 1.5, 2);
  scene.guides = {guide("first", 0.6, {0.5, 0, 0}), guide("second", 1.4, {1.0, 0, 0})};
  World world(scene, {});
  run(world, 0.1);
  ASSERT_TRUE(world.apply(edit::Cut{cable_id(0), world.cables()[0].state.segments() / 2}).ok);
  ASSERT_EQ(world.cables().size(), 2u);
  EXPECT_EQ(world.view_guide(0).cable, 0);
  EXPECT_EQ(world.view_guide(1).cable, 1);
  run(world, 0.2);
}

TEST(GuidedCables, stopAtPinsBesideTheirGuides) {
  SceneDesc scene = scenes::one_cable(50, 2);
  scene.cables[0].point_masses = {scenes::payload(0.5), scenes::payload(1)};
  scene.cables[0].point_masses[0].place.at = PlaceDesc::At::start;
  scene.cables[0].initial.type = InitialShapeDesc::Type::points;
  scene.cables[0].initial.points = {{-0.5, 0, -0.866}, {0, 0, 0}, {0.5, 0, -0.866}};
  scene.guides = {guide("eye", 1, Vector3::Zero())};
  World world(scene, {});
  run(world, 0.05);
  // A node on the light side, where it is: the eyelet cannot draw it in.
  const int node = 12;
  const edit::Pin pin{"pin", cable_id(0), node, 0, Pose{world.cables()[0].state.positions[node]}, AttachmentType::hinge};
  ASSERT_TRUE(world.apply(pin).ok);
  run(world, 1);
  EXPECT_EQ(world.view_guide(0).cable, 0);
  const Attachment& held = world.attachments()[find(world.attachments(), "pin")];
  const std::vector<double> arc_length = world.cables()[0].state.arc_length();
  EXPECT_GT(world.view_guide(0).arc_length, arc_length[held.node]);
  EXPECT_LT((world.cables()[0].state.positions[held.node] - pin.pose.position).norm(), 1e-9);
}

}  // namespace
}  // namespace verlet_cable

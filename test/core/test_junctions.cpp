#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "../support/scenes.h"

// Cables that branch: trees and loops, edited, copied, touching.

namespace verlet_cable {
namespace {

using End = BranchDesc::End;

CableDesc& add_cable(SceneDesc& scene, const std::string& name, double length, int segments) {
  CableDesc& cable = scene.cables.emplace_back();
  cable.name = name;
  cable.length = length;
  cable.segments = segments;
  cable.material = "rope";
  return cable;
}

CableDesc& add_straight(SceneDesc& scene, const std::string& name, int segments, const Vector3& from, const Vector3& to) {
  CableDesc& cable = add_cable(scene, name, (to - from).norm(), segments);
  cable.initial.type = InitialShapeDesc::Type::points;
  cable.initial.points = {from, to};
  return cable;
}

BranchDesc branch(const std::string& cable, End end = End::start, const Vector3& rotation = Vector3::Zero()) {
  BranchDesc desc;
  desc.cable = cable;
  desc.end = end;
  desc.rotation = rotation;
  return desc;
}

JunctionDesc& add_junction(SceneDesc& scene, const std::string& cable, double at, const std::vector<BranchDesc>& branches) {
  JunctionDesc& junction = scene.junctions.emplace_back();
  junction.name = "fork" + std::to_string(scene.junctions.size());
  junction.cable = cable;
  junction.place.at = PlaceDesc::At::arc_length;
  junction.place.arc_length = at;
  junction.branches = branches;
  return junction;
}

SceneDesc nothing() {
  SceneDesc scene = scenes::one_cable(1);
  scene.cables.clear();
  MaterialDesc& material = scene.materials[0].material;
  material.bending_stiffness = 0.02;
  material.torsional_stiffness = 0.015;
  material.bending_damping = material.torsional_damping = 0.001;
  material.drag = 0.1;
  return scene;
}

/// A trunk from the frame "hand" with two branches, of which one ends at it and has a twig of its own; the twig is listed first.
SceneDesc tree() {
  SceneDesc scene = nothing();
  add_cable(scene, "twig", 0.2, 6);
  add_cable(scene, "left", 0.4, 10);
  add_cable(scene, "right", 0.4, 10);
  CableDesc& trunk = add_cable(scene, "trunk", 1, 20);
  trunk.attachments = {scenes::attachment("grip", PlaceDesc::At::start, Vector3::Zero(), "hand", AttachmentType::clamp)};
  trunk.attachments[0].initial_pose = InitialPose{};
  trunk.initial.type = InitialShapeDesc::Type::settled;
  add_junction(scene, "trunk", 0.6, {branch("left", End::start, {0, 0, 0.6}), branch("right", End::end, {0, 0.3, -0.8})});
  add_junction(scene, "right", 0.2, {branch("twig", End::start, {0, 0, 0.5})});
  return scene;
}

/// Two trunks between frames with three rungs.
SceneDesc ladder() {
  SceneDesc scene = nothing();
  for (const double side : {-0.1, 0.1}) {
    const std::string name = side < 0 ? "left" : "right";
    CableDesc& trunk = add_straight(scene, name, 16, {0, side, 0}, {0.8, side, 0});
    trunk.initial.points = {{0, side, 0}, {0.39, side, -0.05}, {0.78, side, 0}};
    trunk.attachments = {scenes::attachment(name + "_start", PlaceDesc::At::start, {0, side, 0}, "", AttachmentType::clamp),
                         scenes::attachment(name + "_end", PlaceDesc::At::end, {0.78, side, 0})};
  }
  for (int i = 1; i <= 3; ++i) {
    const std::string name = "rung" + std::to_string(i);
    add_straight(scene, name, 4, {0.2 * i, -0.1, 0}, {0.2 * i, 0.1, 0});
    add_junction(scene, "left", 0.2 * i, {branch(name)});
    add_junction(scene, "right", 0.2 * i, {branch(name, End::end)});
  }
  return scene;
}

/// A cable that hangs on one end; the other one is joined to its own middle.
SceneDesc noose() {
  SceneDesc scene = nothing();
  CableDesc& cable = add_cable(scene, "noose", 1, 40);
  cable.initial.type = InitialShapeDesc::Type::points;
  const double radius = 0.6 / (2 * M_PI);
  cable.initial.points = {{0, 0, 0}};
  for (int i = 0; i <= 60; ++i) {
    const double angle = 2 * M_PI * i / 60;
    cable.initial.points.emplace_back(radius * std::sin(angle), 0, -0.4 - radius * (1 - std::cos(angle)));
  }
  cable.attachments = {scenes::attachment("top", PlaceDesc::At::start, Vector3::Zero())};
  add_junction(scene, "noose", 0.4, {branch("noose", End::end)});
  return scene;
}

/// A ribbon with a branch whose other end is held, too.
SceneDesc held_ribbon() {
  SceneDesc scene = nothing();
  scene.materials[0].material.bending_stiffness = {0.02, 0.005};
  CableDesc& trunk = add_straight(scene, "trunk", 20, {0, 0, 0}, {0.8, 0, 0});
  trunk.attachments = {scenes::attachment("start", PlaceDesc::At::start, {0, 0, 0}, "", AttachmentType::clamp),
                       scenes::attachment("end", PlaceDesc::At::end, {0.75, 0, 0})};
  trunk.attachments[0].rotation = {0.4, 0, 0};
  trunk.initial.points = {{0, 0, 0}, {0.375, 0, -0.1}, {0.75, 0, 0}};
  CableDesc& arm = add_straight(scene, "arm", 10, {0.4, 0, 0}, {0.4, 0.4, 0});
  arm.initial.points = {{0.38, 0, -0.1}, {0.4, 0.18, -0.2}, {0.4, 0.35, -0.1}};
  arm.attachments = {scenes::attachment("tip", PlaceDesc::At::end, {0.4, 0.35, -0.1}, "", AttachmentType::clamp)};
  arm.attachments[0].rotation = {0, 0, M_PI / 2};
  add_junction(scene, "trunk", 0.4, {branch("arm")}).mass = 0.01;
  return scene;
}

struct Harness {
  const char* name;
  SceneDesc (*scene)();
};

void PrintTo(const Harness& harness, std::ostream* stream) {
  *stream << harness.name;
}

/// [m] The largest between a junction and a node that it joins.
double largest_gap(const World& world) {
  double gap = 0;
  for (const Attachment& attachment : world.attachments())
    if (attachment.is_junction)
      gap = std::max(gap, (world.cables()[attachment.body.index].state.positions[attachment.node] -
                           (world.bodies()[attachment.holder].pose * attachment.pose).position)
                              .norm());
  return gap;
}

void run(World& world, BoundaryInputs& inputs, double duration, double amplitude = 0) {
  for (long steps = std::lround(duration / world.time_step()); steps > 0; --steps) {
    const double t = world.time() + world.time_step();
    if (amplitude > 0 && inputs.size() > 1)
      inputs[1].pose.position = amplitude * Vector3(std::sin(4 * t), 0.5 * (1 - std::cos(7 * t)), 0);
    ASSERT_EQ(world.step(inputs).status, StepResult::Status::ok) << world.time();
  }
}

/// It starts settled, and none of the cable's nodes goes so far [m] within `duration`.
void expect_to_start_at_rest(const SceneDesc& scene, int cable, double duration, double tolerance) {
  BoundaryInputs inputs = initial_frames(scene);
  World world(scene, inputs);
  EXPECT_TRUE(world.findings().unsettled.empty());
  const std::vector<Vector3> before = world.cables()[cable].state.positions;
  run(world, inputs, duration);
  for (std::size_t i = 0; i < before.size(); ++i)
    EXPECT_LT((world.cables()[cable].state.positions[i] - before[i]).norm(), tolerance) << i;
}

/// A trunk between two hands, `gap` [m] apart and `height` above a board, with branches that end at plugs.
SceneDesc above_a_board(double gap, double height) {
  SceneDesc scene = nothing();
  CableDesc& trunk = add_cable(scene, "trunk", 1, 40);
  for (const double side : {-0.5, 0.5}) {
    const PlaceDesc::At at = side < 0 ? PlaceDesc::At::start : PlaceDesc::At::end;
    const std::string name = side < 0 ? "left" : "right";
    trunk.attachments.push_back(scenes::attachment(name, at, {side * gap, 0, height}, "", AttachmentType::clamp));
  }
  for (int i = 0; i < 4; ++i) {
    const std::string name = "b" + std::to_string(i), plug = "plug" + std::to_string(i);
    add_cable(scene, name, 0.25, 12).attachments = {
        scenes::attachment(name + "_end", PlaceDesc::At::end, {-0.015, 0, 0}, "", AttachmentType::clamp)};
    scene.cables.back().attachments[0].body = plug;
    BodyDesc& body = scene.bodies.emplace_back();
    body.name = plug;
    body.mass = 0.02;
    body.shapes.emplace_back();
    body.shapes[0].type = ShapeType::box;
    body.shapes[0].size = {0.03, 0.016, 0.01};
  }
  add_junction(scene, "trunk", 0.4, {branch("b0", End::start, {0, 0, 0.7}), branch("b1", End::start, {0, 0, -1.2})});
  add_junction(scene, "trunk", 0.6, {branch("b2", End::start, {0, 0, 0.5}), branch("b3", End::start, {0, 0, -0.9})});
  ObstacleDesc& board = scene.obstacles.emplace_back();
  board.name = "board";
  board.pose = {0, 0, -0.01, 0, 0, 0};
  board.type = ShapeType::box;
  board.size = {2, 1, 0.02};
  board.friction = 0.4;
  return scene;
}

TEST(Harness, ThatReachesABoardStartsLyingOnItAtRest) {
  for (const double height : {0.15, 0.3})
    for (const double gap : {0.6, 0.9}) {
      const SceneDesc scene = above_a_board(gap, height);
      const BoundaryInputs inputs = initial_frames(scene);
      World world(scene, inputs);
      EXPECT_TRUE(world.findings().unsettled.empty()) << gap << " " << height;
      const double radius = scene.materials[0].material.radius;
      for (const SimulatedCable& cable : world.cables())
        for (int i = 0; i < cable.state.segments(); ++i)  // a plug has its own surface
          EXPECT_GT(cable.state.positions[i].z(), 0.9 * radius) << cable.model->name << " " << i;
      double speed = 0;
      for (int i = 0; i < 200; ++i) {
        EXPECT_EQ(world.step(inputs).status, StepResult::Status::ok);
        for (const SimulatedCable& cable : world.cables())
          for (const Vector3& v : cable.state.velocities) speed = std::max(speed, v.norm());
      }
      EXPECT_LT(speed, 5e-3) << gap << " " << height;
    }
}

/// A trunk between two hands; branches of another material, the first with a hinge, that end at plugs.
SceneDesc with_plugs(const MaterialDesc& of_trunk, const MaterialDesc& of_branches) {
  SceneDesc scene = nothing();
  scene.materials[0].material = of_trunk;
  NamedMaterial branches = scene.materials[0];
  branches.name = "branch";
  branches.material = of_branches;
  scene.materials.push_back(branches);
  CableDesc& trunk = add_cable(scene, "trunk", 0.610828, 36);
  for (const double x : {0.0, 0.315925}) {
    const bool left = x == 0;
    trunk.attachments.push_back(scenes::attachment(left ? "left" : "right", left ? PlaceDesc::At::start : PlaceDesc::At::end,
                                                   {x, 0, 1}, "", AttachmentType::clamp));
  }
  for (int i = 0; i < 2; ++i) {
    const std::string name = "b" + std::to_string(i), plug = "plug" + std::to_string(i);
    CableDesc& cable = add_cable(scene, name, 0.16 + 0.008 * i, 13 + i);
    cable.material = "branch";
    cable.attachments = {scenes::attachment(name + "_end", PlaceDesc::At::end, {-0.015, 0, 0}, "", AttachmentType::clamp)};
    cable.attachments[0].body = plug;
    BodyDesc& body = scene.bodies.emplace_back();
    body.name = plug;
    body.mass = 0.045 - 0.005 * i;
    body.shapes.emplace_back();
    body.shapes[0].type = ShapeType::box;
    body.shapes[0].size = {0.03, 0.016, 0.01};
  }
  add_junction(scene, "trunk", 0.203609, {branch("b0", End::start, {0, 0, 0.521848})}).type = JunctionDesc::Type::hinge;
  add_junction(scene, "trunk", 0.407219, {branch("b1", End::start, {0, 0, 0.799344})});
  return scene;
}

/// What resists no twist may spin by any angle, and what hangs on it, too: it rests in all of them.
TEST(Harness, ThatIsFreeToSpinSettles) {
  MaterialDesc limp;
  limp.linear_density = 0.0146725;
  limp.radius = 0.00115516;
  limp.axial_stiffness = 2738.61;
  limp.axial_damping = 0.273861;
  limp.bending_stiffness = 0.000913601;
  limp.bending_damping = 2.58609e-05;
  MaterialDesc wire = limp;
  wire.linear_density = 0.026;
  wire.radius = 0.00225;
  wire.axial_stiffness = 8.4e4;
  wire.bending_stiffness = 3.7e-4;
  MaterialDesc twisting = wire;
  twisting.torsional_stiffness = 2.7e-4;
  for (const MaterialDesc& of_trunk : {limp, wire, twisting})
    for (const MaterialDesc& of_branches : {wire, twisting})
      expect_to_start_at_rest(with_plugs(of_trunk, of_branches), 1, 0.5, 1e-6);
}

class Harnesses : public testing::TestWithParam<Harness> {};

TEST_P(Harnesses, settleAndStand) {
  for (const JunctionDesc::Type type : {JunctionDesc::Type::rigid, JunctionDesc::Type::hinge}) {
    SceneDesc scene = GetParam().scene();
    for (JunctionDesc& junction : scene.junctions) junction.type = type;
    BoundaryInputs inputs = initial_frames(scene);
    World world(scene, inputs);
    EXPECT_TRUE(world.findings().waiting.empty());
    EXPECT_TRUE(world.findings().unsettled.empty());
    EXPECT_TRUE(world.findings().misfits.empty());
    EXPECT_TRUE(world.settle());
    EXPECT_LT(largest_gap(world), 1e-9);
    const std::vector<Vector3> before = world.cables().back().state.positions;
    // What rests exerts the same from step to step.
    run(world, inputs, 0.1);
    double noise = 0, weight = 0;
    for (const SimulatedCable& cable : world.cables())
      for (const double mass : cable.state.masses) weight += 9.81 * mass;
    for (int i = 0; i < 100 && !testing::Test::HasFatalFailure(); ++i) {
      const std::vector<Attachment> last = world.attachments();
      run(world, inputs, world.time_step());
      for (std::size_t a = 0; a < last.size(); ++a)
        if (!last[a].is_junction) noise = std::max(noise, (world.attachments()[a].force - last[a].force).norm());
    }
    EXPECT_LT(noise, 1e-5 * weight) << (type == JunctionDesc::Type::rigid ? "rigid" : "hinge");
    double moved = 0;
    for (std::size_t i = 0; i < before.size(); ++i)
      moved = std::max(moved, (world.cables().back().state.positions[i] - before[i]).norm());
    EXPECT_LT(moved, 1e-6);
    std::printf("%s: steps of forces at rest %.1e of the weight, way in 0.2 s %.1e m\n", GetParam().name, noise / weight, moved);
  }
}

TEST_P(Harnesses, moveWithoutRinging) {
  SceneDesc scene = GetParam().scene();
  BoundaryInputs inputs = initial_frames(scene);
  World world(scene, inputs);
  world.settle();
  run(world, inputs, 0.3, 0.05);
  // Third differences of forces: smooth motion has none to speak of.
  std::vector<std::vector<Vector3>> forces;
  double weight = 0, rough = 0;
  for (const SimulatedCable& cable : world.cables())
    for (const double mass : cable.state.masses) weight += 9.81 * mass;
  for (int i = 0; i < 300 && !testing::Test::HasFatalFailure(); ++i) {
    run(world, inputs, world.time_step(), 0.05);
    std::vector<Vector3>& now = forces.emplace_back();
    for (const Attachment& attachment : world.attachments())
      if (!attachment.is_junction) now.push_back(attachment.force);
    if (i < 3) continue;
    for (std::size_t a = 0; a < now.size(); ++a)
      rough = std::max(rough, (now[a] - 3 * forces[i - 1][a] + 3 * forces[i - 2][a] - forces[i - 3][a]).norm());
  }
  std::printf("%s: third differences of forces %.1e of the weight\n", GetParam().name, rough / weight);
  EXPECT_LT(rough, 1e-3 * weight);
  EXPECT_LT(largest_gap(world), 1e-9);
}

TEST_P(Harnesses, copiesGoOnWithTheSameBytes) {
  const SceneDesc scene = GetParam().scene();
  BoundaryInputs inputs = initial_frames(scene);
  World world(scene, inputs);
  run(world, inputs, 0.1, 0.05);
  World copy = world, alone = world;
  alone.step_one_by_one(true);
  alone.limit_lanes(1);
  BoundaryInputs of_copy = inputs, of_alone = inputs;
  run(world, inputs, 0.1, 0.05);
  run(copy, of_copy, 0.1, 0.05);
  run(alone, of_alone, 0.1, 0.05);
  EXPECT_EQ(world.hash(), copy.hash());
  EXPECT_EQ(world.hash(), alone.hash());
  World again(scene, initial_frames(scene));
  BoundaryInputs of_again = initial_frames(scene);
  run(again, of_again, 0.2, 0.05);
  EXPECT_EQ(world.hash(), again.hash());
}

/// Cuts beside junctions, on every side of them; pins next to them; winches at ends that are free.
TEST_P(Harnesses, areEditedNextToTheirJunctions) {
  const SceneDesc scene = GetParam().scene();
  World start(scene, initial_frames(scene));
  ASSERT_TRUE(start.settle());
  const std::vector<Attachment> attachments = start.attachments();
  for (const Attachment& attachment : attachments) {
    if (!attachment.is_junction) continue;
    const int segments = start.cables()[attachment.body.index].state.segments();
    for (const int segment : {attachment.node - 2, attachment.node - 1, attachment.node, attachment.node + 1}) {
      if (segment < 0 || segment >= segments) continue;
      World world = start;
      BoundaryInputs inputs = initial_frames(scene);
      const EditResult result = world.apply(edit::Cut{attachment.body, segment});
      SCOPED_TRACE(attachment.name + ", segment " + std::to_string(segment) + ": " + result.message);
      run(world, inputs, 0.05, 0.05);
      EXPECT_LT(largest_gap(world), 1e-9);
      EXPECT_EQ(std::count_if(world.attachments().begin(), world.attachments().end(),
                              [](const Attachment& a) { return a.is_junction; }),
                std::count_if(attachments.begin(), attachments.end(), [](const Attachment& a) { return a.is_junction; }));
    }
    for (const int node : {attachment.node - 1, attachment.node + 1}) {
      if (node < 0 || node > segments) continue;
      World world = start;
      BoundaryInputs inputs = initial_frames(scene);
      edit::Pin pin;
      pin.name = "pin";
      pin.body = attachment.body;
      pin.node = node;
      pin.pose.position = world.cables()[attachment.body.index].state.positions[node];
      const std::vector<Quaternion> material = segment_orientations(world.cables()[attachment.body.index].state);
      pin.pose.orientation = material[std::min<std::size_t>(node, material.size() - 1)];
      pin.type = AttachmentType::clamp;
      SCOPED_TRACE(attachment.name + ", pinned node " + std::to_string(node));
      const EditResult result = world.apply(pin);
      run(world, inputs, 0.05);
      if (result.ok) {
        EXPECT_TRUE(world.apply(edit::Unpin{"pin"}).ok);
        run(world, inputs, 0.02);
      }
      EXPECT_LT(largest_gap(world), 1e-9);
    }
  }
}

const Harness harnesses[] = {{"tree", tree}, {"ladder", ladder}, {"noose", noose}, {"ribbon", held_ribbon}};
INSTANTIATE_TEST_SUITE_P(All, Harnesses, testing::ValuesIn(harnesses));

TEST(Junctions, branchesPayOutAndTakeIn) {
  const SceneDesc scene = tree();
  for (const bool at_end : {false, true}) {
    World world(scene, initial_frames(scene));
    BoundaryInputs inputs = initial_frames(scene);
    const int left = find(world.cables(), "left");
    for (const double length : {0.6, 0.3}) {
      const EditResult result = world.apply(edit::SetLength{left, at_end, length, 0.3});
      ASSERT_TRUE(result.ok) << result.message;
      run(world, inputs, 2.5);
      EXPECT_NEAR(world.cables()[left].state.length(), length, 1e-9) << at_end;
      EXPECT_LT(largest_gap(world), 1e-9);
    }
  }
}

/// Cables without a shape of their own that are joined with themselves, or at both ends with one node; the junctions' cables and
/// nodes.
struct Loop {
  std::string name;
  SceneDesc scene;
};

std::vector<Loop> loops(double bending_stiffness) {
  SceneDesc free = nothing();
  free.materials[0].material.bending_stiffness = bending_stiffness;
  if (bending_stiffness == 0) free.materials[0].material.torsional_stiffness = 0;
  add_cable(free, "cable", 1, 20);
  SceneDesc held = free;
  held.cables[0].attachments = {scenes::attachment("top", PlaceDesc::At::start, {0, 0, 1})};
  SceneDesc held_inside = free;
  held_inside.cables[0].attachments = {scenes::attachment("side", PlaceDesc::At::arc_length, {0, 0, 1})};
  held_inside.cables[0].attachments[0].place.arc_length = 0.7;
  SceneDesc held_at_junction = held;
  held_at_junction.cables[0].attachments.push_back(scenes::attachment("fork", PlaceDesc::At::arc_length, {0.2, 0, 1}));
  held_at_junction.cables[0].attachments[1].place.arc_length = 0.4;
  SceneDesc ears = free;
  SceneDesc straight = held;
  straight.cables[0].initial.type = InitialShapeDesc::Type::straight;
  straight.cables[0].initial.from = {0, 0, 1};
  straight.cables[0].initial.to = {1, 0, 1};
  SceneDesc hung = held;
  add_cable(hung, "loop", 0.6, 12);
  add_junction(hung, "cable", 0.5, {branch("loop"), branch("loop", End::end)});
  for (SceneDesc* noose : {&free, &held, &held_inside, &held_at_junction, &straight})
    add_junction(*noose, "cable", 0.4, {branch("cable", End::end)});
  SceneDesc ring = ears;
  add_junction(ring, "cable", 0, {branch("cable", End::end)});
  add_junction(ears, "cable", 0.3, {branch("cable")});
  add_junction(ears, "cable", 0.7, {branch("cable", End::end)});
  return {{"free", free},
          {"held", held},
          {"held_inside", held_inside},
          {"held_at_junction", held_at_junction},
          {"straight", straight},
          {"hung", hung},
          {"ears", ears},
          {"ring", ring}};
}

TEST(Junctions, cablesWithoutAShapeBeginAsLoops) {
  for (const double bending_stiffness : {0.0, 0.002, 0.02}) {
    for (Loop& loop : loops(bending_stiffness)) {
      for (const JunctionDesc::Type type : {JunctionDesc::Type::rigid, JunctionDesc::Type::hinge}) {
        SCOPED_TRACE(loop.name + " " + std::to_string(bending_stiffness) +
                     (type == JunctionDesc::Type::rigid ? " rigid" : " hinge"));
        for (JunctionDesc& junction : loop.scene.junctions) junction.type = type;
        BoundaryInputs inputs = initial_frames(loop.scene);
        World world(loop.scene, inputs);
        EXPECT_LT(largest_gap(world), 1e-6);
        EXPECT_EQ(world.findings().misfits.size(), loop.name == "straight" ? 1U : 0U);
        const std::vector<Vector3> before = world.cables()[0].state.positions;
        run(world, inputs, world.time_step());
        // Nothing is drawn together by the first step.
        for (std::size_t i = 0; i < before.size(); ++i)
          EXPECT_LT((world.cables()[0].state.positions[i] - before[i]).norm(), 0.01) << i;
        run(world, inputs, 0.3);
        EXPECT_LT(largest_gap(world), 1e-6);
      }
    }
  }
}

/// Clamped there, with an arm that is not joined yet.
SceneDesc trunk_on_a_wall(double arc_length) {
  SceneDesc scene = nothing();
  CableDesc& trunk = add_cable(scene, "trunk", 1, 40);
  trunk.attachments = {scenes::attachment("wall", PlaceDesc::At::arc_length, {0, 0, 1}, "", AttachmentType::clamp)};
  trunk.attachments[0].place.arc_length = arc_length;
  add_cable(scene, "arm", 0.4, 16);
  return scene;
}

TEST(Junctions, trunksMayBeClampedBetweenTheirEnds) {
  for (const Vector3& rotation : {Vector3(0, 0, 0), Vector3(0, 1.5, 0), Vector3(0, -1.5, 0), Vector3(0.3, 0.5, 1.57)}) {
    SceneDesc scene = trunk_on_a_wall(0.8);
    scene.cables[0].attachments[0].rotation = rotation;
    add_junction(scene, "trunk", 0.5, {branch("arm")});
    expect_to_start_at_rest(scene, 0, 0.2, 1e-4);
  }
}

TEST(Junctions, trunksThatHangOnOneAreNotFolded) {
  for (const JunctionDesc::Type type : {JunctionDesc::Type::rigid, JunctionDesc::Type::hinge}) {
    SceneDesc scene = trunk_on_a_wall(0.5);
    add_junction(scene, "trunk", 0.5, {branch("arm", End::start, {0, 0, 0.8})}).type = type;
    BoundaryInputs inputs = initial_frames(scene);
    World world(scene, inputs);
    const std::vector<Vector3>& nodes = world.cables()[0].state.positions;
    for (std::size_t i = 2; i < nodes.size(); ++i) EXPECT_GT((nodes[i] - nodes[i - 1]).dot(nodes[i - 1] - nodes[i - 2]), 0) << i;
    run(world, inputs, 0.2);
  }
}

TEST(Junctions, waitForEveryFrameOfTheHarness) {
  SceneDesc scene = ladder();
  scene.cables[0].attachments[0].frame = "early";
  scene.cables[1].attachments[1].frame = "late";
  BoundaryInputs inputs = initial_frames(scene);
  inputs[1].known = inputs[2].known = false;
  World world(scene, inputs);
  EXPECT_EQ(world.findings().waiting.size(), scene.cables.size());
  inputs[1].known = true;
  EXPECT_EQ(world.start_waiting(inputs), 0);
  inputs[2].known = true;
  EXPECT_EQ(world.start_waiting(inputs), static_cast<int>(scene.cables.size()));
  EXPECT_TRUE(world.findings().waiting.empty());
  EXPECT_LT(largest_gap(world), 1e-9);
  run(world, inputs, 0.2);
}

/// A trunk as long as its frames are apart has no room to sag between them, with a junction inside or without one.
TEST(Junctions, betweenFramesMayBePulledStraight) {
  for (const AttachmentType type : {AttachmentType::hinge, AttachmentType::clamp}) {
    SceneDesc scene = nothing();
    CableDesc& trunk = add_straight(scene, "trunk", 10, {0, 0, 0}, {1, 0, 0});
    trunk.attachments = {scenes::attachment("start", PlaceDesc::At::start, Vector3::Zero(), "", type),
                         scenes::attachment("end", PlaceDesc::At::end, Vector3::Zero(), "hand", type)};
    trunk.attachments[1].initial_pose = InitialPose{1, 0, 0, 0, 0, 0};
    add_straight(scene, "arm", 5, {0.5, 0, 0}, {0.5, 0.4, 0});
    add_junction(scene, "trunk", 0.5, {branch("arm")});
    BoundaryInputs inputs = initial_frames(scene);
    World world(scene, inputs);
    run(world, inputs, 0.1);
    for (int i = 1; i <= 200; ++i) {
      inputs[1].pose.position.x() = 1 - 0.0005 * i;
      ASSERT_EQ(world.step(inputs).status, StepResult::Status::ok) << i;
    }
    EXPECT_LT(largest_gap(world), 1e-9);
    // Drawn beyond its length it is lengthened, as without a junction, and comes back.
    const auto draw = [&](double speed) {
      inputs[1].pose.position.x() += speed * world.time_step();
      return world.step(inputs).status;
    };
    for (int i = 0; i < 300; ++i) {
      const StepResult::Status status = draw(0.5);
      const bool is_beyond = inputs[1].pose.position.x() > 1 + 1e-6;
      ASSERT_EQ(status, is_beyond ? StepResult::Status::overstretched : StepResult::Status::ok) << i;
    }
    for (int i = 0; i < 300; ++i) draw(-0.5);
    for (int i = 0; i < 100; ++i) ASSERT_EQ(world.step(inputs).status, StepResult::Status::ok) << i;
  }
}

/// By default a trunk that one frame holds hangs straight down, out of the reach of a branch whose end is held elsewhere.
TEST(Junctions, branchesReachWhatHoldsThem) {
  for (const double bending_stiffness : {0.0, 0.02})
    for (const AttachmentType type : {AttachmentType::hinge, AttachmentType::clamp}) {
      SceneDesc scene = nothing();
      scene.materials[0].material.bending_stiffness = bending_stiffness;
      add_cable(scene, "trunk", 0.5, 10).attachments = {
          scenes::attachment("start", PlaceDesc::At::start, Vector3::Zero(), "", type)};
      add_cable(scene, "arm", 0.4, 8).attachments = {scenes::attachment("end", PlaceDesc::At::end, {0.6, 0, 0}, "", type)};
      add_junction(scene, "trunk", 0.4, {branch("arm")});
      World world(scene, {});
      EXPECT_LT(largest_gap(world), 1e-6);
      ASSERT_TRUE(world.settle());
      BoundaryInputs inputs;
      run(world, inputs, 0.1);
      Vector3 force = Vector3::Zero();
      double mass = 0;
      for (const Attachment& attachment : world.attachments())
        if (is_named(attachment)) force += attachment.force;
      for (const SimulatedCable& cable : world.cables())
        for (const double part : cable.state.masses) mass += part;
      EXPECT_LT((force - scene.gravity.acceleration * mass).norm(), 1e-3 * mass * scene.gravity.acceleration.norm());
    }
}

/// By default a branch goes on along its trunk, turned by its rotation in the trunk's material axes.
TEST(Junctions, branchesBeginAlongTheirTrunkTurned) {
  SceneDesc scene = nothing();
  scene.materials[0].material.bending_stiffness = {0.02, 0.01};
  scene.gravity.acceleration.setZero();
  CableDesc& trunk = add_straight(scene, "trunk", 10, {0, 0, 0}, {1, 0, 0});
  trunk.attachments = {scenes::attachment("start", PlaceDesc::At::start, {0, 0, 0}, "", AttachmentType::clamp)};
  trunk.attachments[0].rotation = {M_PI / 2, 0, 0};  // the material's y is the fixed frame's z
  add_cable(scene, "off", 0.5, 5);
  add_cable(scene, "back", 0.5, 5);
  add_junction(scene, "trunk", 0.5, {branch("off", End::start, {0, 0, M_PI / 2}), branch("back", End::end, {0.3, 0, M_PI / 2})});
  World world(scene, initial_frames(scene));
  BoundaryInputs inputs = initial_frames(scene);
  const CableState &off = world.cables()[find(world.cables(), "off")].state,
                   &back = world.cables()[find(world.cables(), "back")].state;
  EXPECT_LT((off.positions.back() - Vector3(0.5, 0, 0.5)).norm(), 1e-9);
  EXPECT_LT((back.positions.front() - Vector3(0.5, 0, 0.5)).norm(), 1e-9);
  // With the trunk's roll: there is nothing to turn or bend back.
  run(world, inputs, 0.5);
  EXPECT_LT((world.cables()[find(world.cables(), "off")].state.positions.back() - Vector3(0.5, 0, 0.5)).norm(), 1e-7);
  EXPECT_LT((world.cables()[find(world.cables(), "back")].state.positions.front() - Vector3(0.5, 0, 0.5)).norm(), 1e-7);
}

/// A cable of two pieces is the whole one: it is straight where they are joined, and their clamps do not twist it.
TEST(Junctions, joinPiecesToTheWholeCable) {
  const auto shape = [](const InitialShapeDesc::Type type, const Vector3& turned, bool in_two, Vector3& torque) {
    SceneDesc scene = nothing();
    add_cable(scene, "first", in_two ? 0.8 : 1.2, in_two ? 16 : 24);
    if (in_two) {
      add_cable(scene, "second", 0.4, 8);
      add_junction(scene, "first", 0.8, {branch("second")});
    }
    for (CableDesc& cable : scene.cables) cable.initial.type = type;
    scene.cables.front().attachments = {
        scenes::attachment("left", PlaceDesc::At::start, Vector3::Zero(), "", AttachmentType::clamp)};
    scene.cables.back().attachments.push_back(
        scenes::attachment("right", PlaceDesc::At::end, {0.6, 0.3 * turned.z(), 0.1}, "", AttachmentType::clamp));
    scene.cables.back().attachments.back().rotation = turned;
    World world(scene, {});
    EXPECT_TRUE(world.findings().unsettled.empty());
    BoundaryInputs inputs;
    run(world, inputs, 2 * world.time_step());
    torque = world.attachments()[find(world.attachments(), "left")].torque;
    std::vector<Vector3> nodes = world.cables()[0].state.positions;
    if (in_two) nodes.insert(nodes.end(), world.cables()[1].state.positions.begin() + 1, world.cables()[1].state.positions.end());
    return nodes;
  };
  for (const InitialShapeDesc::Type type : {InitialShapeDesc::Type::automatic, InitialShapeDesc::Type::settled})
    for (const Vector3& turned : {Vector3(0, 0, 0), Vector3(0.5, 0.8, 1)}) {
      Vector3 of_whole, of_pieces;
      const std::vector<Vector3> whole = shape(type, turned, false, of_whole), pieces = shape(type, turned, true, of_pieces);
      ASSERT_EQ(whole.size(), pieces.size());
      // Both are settled to 1e-7 m; twist is taken out to 1e-7 rad at a time.
      for (std::size_t i = 0; i < whole.size(); ++i) EXPECT_LT((pieces[i] - whole[i]).norm(), 2e-5) << i;
      EXPECT_LT((of_pieces - of_whole).norm(), 1e-3 * of_whole.norm());
    }
}

/// Where cables touch each other, those that a junction joins do not push each other apart beside it.
TEST(Junctions, branchesDoNotPushTheirTrunk) {
  SceneDesc scene = tree();
  const SceneDesc without = scene;
  scene.contact = ContactDesc{};
  World world(scene, initial_frames(scene)), other(without, initial_frames(without));
  BoundaryInputs inputs = initial_frames(scene), of_other = inputs;
  run(world, inputs, 0.3, 0.02);
  run(other, of_other, 0.3, 0.02);
  EXPECT_TRUE(world.findings().contacts.empty());
  for (std::size_t k = 0; k < world.cables().size(); ++k)
    for (int i = 0; i < world.cables()[k].state.nodes(); ++i)
      EXPECT_LT((world.cables()[k].state.positions[i] - other.cables()[k].state.positions[i]).norm(), 1e-9);
}

/// A trunk that only a clamp inside it holds, where a branch comes off, begins folded back on itself there.
TEST(Junctions, haveFiniteMotionWhereTheirTrunkIsFolded) {
  SceneDesc scene = nothing();
  CableDesc& trunk = add_cable(scene, "trunk", 1, 40);
  trunk.attachments = {scenes::attachment("grip", PlaceDesc::At::arc_length, Vector3::Zero(), "", AttachmentType::clamp)};
  trunk.attachments[0].place.arc_length = 0.5;
  add_cable(scene, "branch", 0.3, 12);
  add_junction(scene, "trunk", 0.5, {branch("branch", End::start, {0, 0, 0.6})});
  World world(scene, initial_frames(scene));
  EXPECT_TRUE(std::isfinite(world.energy().total()));
  for (const SimulatedBody& body : world.bodies()) EXPECT_TRUE(body.angular_velocity.allFinite()) << body.name;
  world.step(initial_frames(scene));
  EXPECT_TRUE(std::isfinite(world.energy().total()));
}

/// A harness that falls onto a floor comes to rest on it, its junctions, too.
TEST(Junctions, lieOnAFloor) {
  SceneDesc scene = nothing();
  add_straight(scene, "trunk", 20, {0, 0, 0.03}, {0.8, 0, 0.03});
  add_straight(scene, "arm", 10, {0.4, 0, 0.03}, {0.4, 0.4, 0.03});
  add_straight(scene, "leg", 10, {0.6, -0.4, 0.03}, {0.6, 0, 0.03});
  add_junction(scene, "trunk", 0.4, {branch("arm")}).mass = 0.05;
  add_junction(scene, "trunk", 0.6, {branch("leg", End::end)});
  ObstacleDesc& floor = scene.obstacles.emplace_back();
  floor.name = "floor";
  World world(scene, initial_frames(scene));
  BoundaryInputs inputs = initial_frames(scene);
  run(world, inputs, 1);
  EXPECT_LT(world.energy().kinetic, 1e-6);
  const double radius = scene.materials[0].material.radius;
  for (const SimulatedCable& cable : world.cables())
    for (const Vector3& position : cable.state.positions) EXPECT_NEAR(position.z(), radius, 0.1 * radius);
}

}  // namespace
}  // namespace verlet_cable

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "../support/meshes.h"
#include "../support/nets.h"
#include "../support/scenes.h"
#include "../support/translated.h"

// The same scene, 10 km away from the fixed frame's origin.

namespace verlet_cable {
namespace {

/// The nearest that doubles come to the same place there is 2e-12 m; a step adds as much, and nothing that lives in it grows.
constexpr double tolerance = 1e-6;

using Drive = std::function<void(int step, const Vector3& by, World& world, BoundaryInputs& inputs)>;

struct Case {
  std::string name;
  SceneDesc scene;
  double seconds = 2;
  Drive drive = [](int, const Vector3&, World&, BoundaryInputs&) {};
};

std::ostream& operator<<(std::ostream& stream, const Case& scene) {
  return stream << scene.name;
}

AttachmentDesc clamp(const std::string& name, PlaceDesc::At at, const Vector3& offset, const std::string& frame = "") {
  return scenes::attachment(name, at, offset, frame, AttachmentType::clamp);
}

SceneDesc stiff(SceneDesc scene, double bending, double axial = infinity) {
  scene.materials[0].material.bending_stiffness = bending;
  scene.materials[0].material.bending_damping = 1e-3 * bending;
  scene.materials[0].material.torsional_stiffness = 0.8 * bending;
  scene.materials[0].material.axial_stiffness = axial;
  return scene;
}

SceneDesc curl(SceneDesc scene) {
  scene.cables[0].initial.type = InitialShapeDesc::Type::points;
  for (int i = 0; i <= 40; ++i) {
    const double angle = 0.1 * i;
    scene.cables[0].initial.points.push_back({0.25 * std::cos(angle), 0.25 * std::sin(angle), 0.005 * i});
  }
  return scene;
}

SceneDesc straight(SceneDesc scene, const Vector3& from, const Vector3& to) {
  scene.cables[0].initial.type = InitialShapeDesc::Type::straight;
  scene.cables[0].initial.from = from;
  scene.cables[0].initial.to = to;
  return scene;
}

SceneDesc over(ShapeType type, SceneDesc scene) {
  ObstacleDesc obstacle;
  obstacle.name = "obstacle";
  obstacle.type = type;
  obstacle.pose = {0.02, 0.01, -0.2, 0.1, 0.2, 0.3};
  obstacle.radius = 0.08;
  obstacle.length = 0.3;
  obstacle.size = {0.3, 0.3, 0.15};
  obstacle.friction = 0.5;
  if (type == ShapeType::mesh) obstacle.mesh = box_triangles({0.3, 0.3, 0.15}).mesh();
  scene.obstacles = {obstacle};
  return scene;
}

void swing(int step, const Vector3& by, World&, BoundaryInputs& inputs) {
  const double t = 1e-3 * step;
  inputs[1].pose.position = by + Vector3(0.6 + 0.1 * std::sin(3 * t), 0.1 * std::sin(2 * t), 0.05 * std::sin(5 * t));
  inputs[1].pose.orientation = quaternion_from_rpy({0.3 * std::sin(2 * t), 0.2 * std::sin(t), 0});
}

std::vector<Case> cases() {
  std::vector<Case> all;
  const SceneDesc level = scenes::between_two_points(50, 0.6);
  const SceneDesc rope = scenes::one_cable(50);
  all.push_back({"catenary", level});
  all.push_back({"catenary_elastic", stiff(level, 0, 1e4)});
  all.push_back({"taut", scenes::between_two_points(50, 1)});
  all.push_back({"short_segments", scenes::between_two_points(1000, 0.6), 0.2});
  all.push_back({"straight", straight(rope, {0, 0, 0}, {1, 0.3, 0.2})});
  all.push_back({"straight_held", scenes::released(50, 1.2)});
  all.push_back({"straight_stiff", stiff(scenes::released(50, 1.2), 0.01)});
  all.push_back({"points", curl(rope)});
  all.push_back({"points_stiff", curl(stiff(rope, 1e-3))});
  all.push_back({"points_elastic", curl(stiff(rope, 1e-3, 1e4))});
  SceneDesc clamped = stiff(rope, 0.01);
  clamped.cables[0].attachments = {clamp("left", PlaceDesc::At::start, {0, 0, 0}),
                                   clamp("right", PlaceDesc::At::end, {0.6, 0, 0})};
  all.push_back({"clamped", clamped});
  clamped.cables[0].initial.type = InitialShapeDesc::Type::settled;
  all.push_back({"settled", clamped});
  SceneDesc soft = clamped;
  soft.materials[0].material.bending_stiffness = soft.materials[0].material.torsional_stiffness = 0;
  all.push_back({"clamped_rope", soft});
  SceneDesc fluid = clamped;
  fluid.fluid.density = 1000;
  fluid.fluid.velocity = {0.2, 0.1, 0};
  fluid.fluid.surface = -0.1;
  all.push_back({"fluid", fluid});
  SceneDesc central = scenes::released(50, 1.2);
  central.gravity.type = GravityDesc::Type::central;
  central.gravity.mu = 150;
  central.gravity.center = {0.3, 0.2, -4};
  all.push_back({"central", central});
  for (const double axial : {infinity, 1e4})
    all.push_back({axial < infinity ? "hand_elastic" : "hand",
                   stiff(scenes::held_by_a_hand(50, AttachmentType::clamp), 0.01, axial), 2, swing});
  for (const ShapeType type :
       {ShapeType::plane, ShapeType::sphere, ShapeType::capsule, ShapeType::cylinder, ShapeType::box, ShapeType::mesh}) {
    const char* names[] = {"plane", "sphere", "capsule", "cylinder", "box", "mesh"};
    all.push_back({std::string("over_") + names[static_cast<int>(type)],
                   over(type, stiff(straight(scenes::one_cable(30, 0.5), {-0.25, 0, 0.03}, {0.25, 0, 0.03}), 1e-3)), 0.4});
  }
  SceneDesc touching = curl(stiff(rope, 1e-4));
  touching.contact = ContactDesc{};
  touching.obstacles = over(ShapeType::plane, rope).obstacles;
  all.push_back({"self_contact", touching, 0.4});
  for (const LinkType type : {LinkType::spring, LinkType::limited, LinkType::rigid}) {
    const char* names[] = {"spring", "limited", "rigid"};
    const bool rigid = type == LinkType::rigid;
    // A rigid link that leaves its bounds (a part in ten thousand) is set to its rest length in one step. Near that, rounding of
    // any size decides: at the origin a push of 1e-10 m, too, makes the sheet differ by 2e-4 m after 0.25 s, the flag by 1e-10 m
    // already after as much. Until then both are far away what they are here.
    if (rigid) {
      SceneDesc chain;
      chain.nets = {scenes::chain({{0, 0, 0}, {0.1, 0, 0}, {0.2, 0, 0}, {0.3, 0, 0}, {0.4, 0, 0}}, type)};
      chain.nets[0].attachments = {scenes::net_attachment("held", 0, {0, 0, 0})};
      all.push_back({"chain_rigid", chain, 1});
    }
    SceneDesc flag = scenes::flag(5, 6, 0.05, type);
    flag.fluid.density = 1.2;
    flag.fluid.velocity = {2, 1, 0};
    all.push_back({std::string("flag_") + names[static_cast<int>(type)], flag, rigid ? 0.1 : 0.5});
    SceneDesc sheet;
    sheet.nets = {scenes::grid(5, 5, 0.06, type)};
    sheet.nets[0].grid->origin = {-0.1, -0.1, 0};
    sheet.nets[0].grid->y_axis = {0, 1, 0};
    all.push_back({std::string("sheet_") + names[static_cast<int>(type)], over(ShapeType::sphere, sheet), rigid ? 0.15 : 0.3});
  }
  all.push_back({"planet", scenes::planet(1e-3, IntegratorDesc::Type::verlet)});
  all.push_back({"winch", scenes::released(50, 0.3), 2, [](int step, const Vector3&, World& world, BoundaryInputs&) {
                   if (step == 100) {
                     EXPECT_TRUE(world.apply(edit::SetLength{0, false, 1.3, 0.5}).ok);
                   }
                   if (step == 1000) {
                     EXPECT_TRUE(world.apply(edit::SetLength{0, false, 0.9, 0.5}).ok);
                   }
                 }});
  all.push_back({"cut_pin_and_join", stiff(level, 1e-3), 2, [](int step, const Vector3& by, World& world, BoundaryInputs&) {
                   const Pose pose{by + Vector3(0.3, 0.2, 0.1), Quaternion::Identity()};
                   if (step == 100) {
                     EXPECT_TRUE(world.apply(edit::Pin{"mine", cable_id(0), 25, 0, pose, AttachmentType::clamp}).ok);
                   }
                   if (step == 800) {
                     EXPECT_TRUE(world.apply(edit::Cut{cable_id(0), 35}).ok);
                   }
                   if (step == 1000) {
                     EXPECT_TRUE(world.apply(edit::Unpin{"mine"}).ok);
                   }
                   if (step == 1100) {
                     EXPECT_TRUE(world.apply(edit::Join{0, true, 1, false}).ok);
                   }
                 }});
  return all;
}

class FarAway : public ::testing::TestWithParam<Case> {};

double largest_difference(const World& a, const World& b, const Vector3& by) {
  double largest = 0;
  const auto compare = [&](const std::vector<Vector3>& p, const std::vector<Vector3>& q) {
    EXPECT_EQ(p.size(), q.size());
    for (std::size_t i = 0; i < std::min(p.size(), q.size()); ++i) largest = std::max(largest, (q[i] - by - p[i]).norm());
  };
  for (std::size_t i = 0; i < a.cables().size(); ++i) compare(a.cables()[i].state.positions, b.cables()[i].state.positions);
  for (std::size_t i = 0; i < a.nets().size(); ++i) compare(a.nets()[i].state.positions, b.nets()[i].state.positions);
  for (std::size_t i = 0; i < a.particles().size(); ++i) compare({a.particles()[i].position}, {b.particles()[i].position});
  return largest;
}

TEST_P(FarAway, MovesAsAtTheOrigin) {
  const Case& scene = GetParam();
  for (const Vector3& by : {Vector3(1e4, -1e4, 1e4), Vector3(-3e3, 7e2, 0)}) {
    const SceneDesc there = scenes::translated(scene.scene, by);
    BoundaryInputs inputs = scenes::hand_at({0.6, 0, 0}), inputs_there = scenes::translated(inputs, by);
    World world(scene.scene, inputs), far(there, inputs_there);
    EXPECT_EQ(world.findings().misfits, far.findings().misfits);
    EXPECT_EQ(world.findings().unsettled, far.findings().unsettled);
    ASSERT_EQ(world.cables().size(), far.cables().size());
    EXPECT_LT(largest_difference(world, far, by), tolerance) << "at the start";
    double largest = 0;
    for (int i = 1; i <= 1000 * scene.seconds; ++i) {
      scene.drive(i, Vector3::Zero(), world, inputs);
      scene.drive(i, by, far, inputs_there);
      const StepResult a = world.step(inputs), b = far.step(inputs_there);
      ASSERT_EQ(a.status, b.status) << "step " << i;
      largest = std::max(largest, largest_difference(world, far, by));
    }
    EXPECT_LT(largest, tolerance) << by.transpose();
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, FarAway, ::testing::ValuesIn(cases()), [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace verlet_cable

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "../support/scenes.h"

namespace verlet_cable {
namespace {

using Status = StepResult::Status;

/// A plug in a hand, at the end of an inextensible wire of 1 m whose other end a wall holds.
SceneDesc plug_in_a_hand(AttachmentType hold, AttachmentType end) {
  SceneDesc scene = scenes::one_cable(30, 1.0);
  scene.time_step = 0.002;
  MaterialDesc& wire = scene.materials[0].material;
  wire.linear_density = 0.05;
  wire.radius = 0.003;
  wire.bending_stiffness = 0.001;
  wire.bending_damping = 1e-5;
  scene.cables[0].attachments = {scenes::attachment("wall", PlaceDesc::At::start, {0, 0, 1}),
                                 scenes::attachment("plugged", PlaceDesc::At::end, {0, 0, 0})};
  scene.cables[0].attachments[1].body = "plug";
  scene.cables[0].attachments[1].type = end;
  BodyDesc& plug = scene.bodies.emplace_back();
  plug.name = "plug";
  plug.mass = 0.05;
  plug.inertia = Vector3(8e-6, 8e-6, 4e-6);
  BodyAttachmentDesc& grip = plug.attachments.emplace_back();
  grip.name = "grip";
  grip.frame = "hand";
  grip.type = hold;
  return scene;
}

class OverstretchedBodies : public testing::TestWithParam<std::tuple<AttachmentType, AttachmentType>> {
 protected:
  /// The hand goes to a distance from the wall [m] at 0.2 m/s, and waits there for half a second.
  void draw_to(double distance) {
    const int steps = static_cast<int>(std::abs(distance - distance_) / 0.2 / 0.002), waits = 250;
    const double start = distance_;
    for (int i = 1; i <= steps + waits; ++i) {
      distance_ = start + (distance - start) * std::min(1.0, static_cast<double>(i) / steps);
      last_ = world_.step(scenes::hand_at({distance_, 0, 1})).status;
      overstretched_steps_ += last_ == Status::overstretched;
      for (const double tension : world_.cables()[0].state.tension) greatest_ = std::max(greatest_, std::abs(tension));
    }
  }
  double tension() const { return world_.cables()[0].state.tension[15]; }

  double distance_ = 0.6;
  World world_{plug_in_a_hand(std::get<0>(GetParam()), std::get<1>(GetParam())), scenes::hand_at({distance_, 0, 1})};
  Status last_ = Status::ok;
  int overstretched_steps_ = 0;
  double greatest_ = 0;  ///< [N] tension
};

/// What is drawn beyond its length gives in as a soft rope does, of an axial stiffness of 1e4 times the weight of 0.1 kg.
TEST_P(OverstretchedBodies, HaveBoundedTensionsAndAreTold) {
  draw_to(0.99);
  EXPECT_EQ(overstretched_steps_, 0);
  EXPECT_LT(greatest_, 50);
  draw_to(1.2);
  EXPECT_EQ(last_, Status::overstretched);
  EXPECT_GT(overstretched_steps_, 250);
  EXPECT_NEAR(tension(), 0.2 * 1e4 * 0.1 * 9.81, 0.2 * 0.2 * 1e4 * 0.1 * 9.81);
  EXPECT_LT(greatest_, 2e4);
}

TEST_P(OverstretchedBodies, HangAsBeforeOnceTheyAreLetBack) {
  draw_to(0.9);
  draw_to(1.2);
  draw_to(0.9);
  EXPECT_EQ(last_, Status::ok);
  for (int i = 0; i < 1500; ++i) world_.step(scenes::hand_at({distance_, 0, 1}));
  EXPECT_LT(std::abs(tension()), 1);  // [N] twice the weight of the wire, which swings
}

INSTANTIATE_TEST_SUITE_P(Holders, OverstretchedBodies,
                         testing::Combine(testing::Values(AttachmentType::hinge, AttachmentType::clamp),
                                          testing::Values(AttachmentType::hinge, AttachmentType::clamp)));

/// A bar of 1 kg on two inextensible ropes of 0.6 m, whose second holder jumps up and aside, and back.
TEST(OverstretchedRopes, AreToldWhereverWhatCannotStretchIsStrained) {
  SceneDesc scene = scenes::one_cable(20, 0.6);
  scene.time_step = 0.002;
  BodyDesc& bar = scene.bodies.emplace_back();
  bar.name = "bar";
  bar.mass = 1;
  bar.inertia = Vector3(0.001, 0.02, 0.02);
  bar.pose = InitialPose{0.2, 0, -0.6, 0, 0, 0};
  const auto rope = [](const std::string& name, double x, const std::string& frame) {
    CableDesc cable = scenes::one_cable(20, 0.6).cables[0];
    cable.name = name;
    cable.attachments = {scenes::attachment(name + "_top", PlaceDesc::At::start, {frame.empty() ? x : 0, 0, 0}, frame),
                         scenes::attachment(name + "_bar", PlaceDesc::At::end, {x - 0.2, 0, 0})};
    cable.attachments[1].body = "bar";
    return cable;
  };
  scene.cables = {rope("left", 0, ""), rope("right", 0.4, "hand")};
  World world(scene, scenes::hand_at({0.4, 0, 0}));
  int strained = 0;
  for (int i = 0; i < 2000; ++i) {
    const bool away = i >= 200 && i < 700;
    const Status status = world.step(scenes::hand_at(away ? Vector3(0.7, 0, 0.3) : Vector3(0.4, 0, 0))).status;
    double greatest = 0;
    for (const SimulatedCable& cable : world.cables())
      for (int k = 0; k < cable.state.segments(); ++k) greatest = std::max(greatest, std::abs(strain(cable.state, k)));
    if (!(greatest > 0.01)) continue;
    ++strained;
    EXPECT_GE(status, Status::overstretched) << "step " << i << ": " << greatest;
  }
  EXPECT_GT(strained, 0);
}

/// A rope of 1.2 m from the frame "base" to "hand", 1 m apart, and a branch of 0.54 m that leaves it and comes back to it.
SceneDesc loop_on_a_rope(JunctionDesc::Type type) {
  SceneDesc scene = scenes::held_by_a_hand(30, AttachmentType::clamp);
  scene.time_step = 0.002;
  scene.materials[0].material.drag = 0.15;
  scene.cables[0].length = 1.2;
  CableDesc& loop = scene.cables.emplace_back();
  loop.name = "loop";
  loop.length = 0.54;
  loop.segments = 12;
  loop.material = "rope";
  loop.initial.type = InitialShapeDesc::Type::points;
  loop.initial.points = {{0.4, 0, -0.15}, {0.45, 0.12, -0.22}, {0.55, 0.17, -0.25}, {0.65, 0.12, -0.22}, {0.7, 0, -0.15}};
  for (const BranchDesc::End end : {BranchDesc::End::start, BranchDesc::End::end}) {
    const bool is_start = end == BranchDesc::End::start;
    BranchDesc branch;
    branch.cable = "loop";
    branch.end = end;
    JunctionDesc& junction = scene.junctions.emplace_back();
    junction.name = is_start ? "off" : "back";
    junction.cable = "cable";
    junction.place.at = PlaceDesc::At::arc_length;
    junction.place.arc_length = is_start ? 0.4 : 0.76;
    junction.type = type;
    junction.branches = {branch};
  }
  return scene;
}

/// Drawn out to 1.5 times its length, and let go again: it comes to rest as drag of 0.15 kg/(m s) on 0.1 kg/m lets it.
TEST(OverstretchedHarness, HangsAgainWhenItsFramesHaveComeBack) {
  for (const JunctionDesc::Type type : {JunctionDesc::Type::hinge, JunctionDesc::Type::rigid}) {
    World world(loop_on_a_rope(type), scenes::hand_at({1, 0, 0}));
    int overstretched = 0;
    for (int i = 1; i <= 300; ++i) {
      const double out = std::sin(M_PI * i / 300);
      const Status status = world.step(scenes::hand_at({1 + 0.8 * out * out, 0, 0})).status;
      EXPECT_NE(status, Status::degraded) << i;
      overstretched += status == Status::overstretched;
    }
    EXPECT_GT(overstretched, 150);
    Status last = Status::degraded;
    for (int i = 0; i < 2500; ++i) last = world.step(scenes::hand_at({1, 0, 0})).status;
    EXPECT_EQ(last, Status::ok);
    for (const SimulatedCable& cable : world.cables()) {
      double length = 0;
      for (int i = 0; i < cable.state.segments(); ++i) length += (cable.state.positions[i + 1] - cable.state.positions[i]).norm();
      EXPECT_NEAR(length, cable.state.length(), 1e-5) << cable.model->name;
    }
    // 0.17 kg
    EXPECT_LT(world.attachments()[1].force.norm(), 0.174 * 9.81);
    EXPECT_LT(world.energy().kinetic, 1e-3);
  }
}

}  // namespace
}  // namespace verlet_cable

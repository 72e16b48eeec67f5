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
                                 scenes::attachment("plugged", PlaceDesc::At::end, {})};
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

}  // namespace
}  // namespace verlet_cable

#include <gtest/gtest.h>

#include "edit_requests/checked_pin.h"
#include "edit_requests/error_text.h"
#include "edit_requests/location.h"
#include "requests/requested.h"
#include "requests/rollout.h"

namespace verlet_cable {
namespace {

/// A load that nothing holds, a wheel on an axle beside its origin, and a plate that is clamped.
World three_bodies() {
  SceneDesc scene;
  for (const char* name : {"load", "wheel", "plate"}) {
    BodyDesc& body = scene.bodies.emplace_back();
    body.name = name;
    body.mass = 1;
    body.inertia = Vector3(1, 1, 1);
    body.pose = InitialPose{1, 2, 3, 0, 0, M_PI_2};
  }
  BodyAttachmentDesc attachment;
  attachment.name = "axle";
  attachment.type = AttachmentType::axle;
  attachment.at = {0.1, 0, 0, 0, 0, 0};
  attachment.offset = {1, 2.1, 3};
  attachment.rotation = {0, 0, M_PI_2};
  scene.bodies[1].attachments = {attachment};
  attachment.name = "bolt";
  attachment.type = AttachmentType::clamp;
  scene.bodies[2].attachments = {attachment};
  return World(scene, initial_frames(scene));
}

std::optional<Pose> find_frame(const std::string& frame) {
  if (frame == "world" || frame == "load") return Pose{};
  if (frame == "hand") return Pose{Vector3(1, 0, 0), Quaternion::Identity()};
  return std::nullopt;
}

Pin::Request pin_request(const std::string& body, const std::string& frame, bool clamp) {
  Pin::Request request;
  request.location.cable = body;
  request.location.mode = CableLocation::NODE;
  request.frame_id = frame;
  request.clamp = clamp;
  return request;
}

std::string pin_errors(const Pin::Request& request) {
  return join(check_pin(requested_pin(request), three_bodies(), find_frame).errors);
}

TEST(BodyRequests, aBodyHasItsOriginOnly) {
  const World world = three_bodies();
  CableLocation location = pin_request("wheel", "", false).location;
  EXPECT_EQ(locate_node(requested_place(location), world, find_frame).body, rigid_body_id(1));
  location.node = 3;
  EXPECT_EQ(join(locate_node(requested_place(location), world, find_frame).errors),
            "location.node: 3; allowed: 0, the origin of the body's frame");
  location.mode = CableLocation::ARC_LENGTH;
  EXPECT_EQ(join(locate_node(requested_place(location), world, find_frame).errors),
            "location.mode: 1 for body \"wheel\"; allowed: 0 (NODE)");
  EXPECT_EQ(join(locate_cut(requested_place(location), world, find_frame).errors),
            "location.cable: \"wheel\"; allowed: none, there are no cables or nets");
}

TEST(BodyRequests, aBodyIsPinnedWhereItIs) {
  Pin::Request request = pin_request("load", "hand", true);
  request.keep_offset = true;
  const CheckedPin pin = check_pin(requested_pin(request), three_bodies(), find_frame);
  EXPECT_TRUE(pin.errors.empty()) << join(pin.errors);
  EXPECT_EQ(pin.body, rigid_body_id(0));
  EXPECT_EQ(pin.node, 0);
  EXPECT_LT((pin.offset.position - Vector3(0, 2, 3)).norm(), 1e-15);
  EXPECT_LT(pin.offset.orientation.angularDistance(quaternion_from_rpy({0, 0, M_PI_2})), 1e-15);
}

TEST(BodyRequests, whatHoldsABodyAlreadyMatters) {
  EXPECT_EQ(pin_errors(pin_request("load", "hand", false)), "");
  EXPECT_EQ(pin_errors(pin_request("wheel", "hand", false)), "");
  EXPECT_EQ(pin_errors(pin_request("wheel", "hand", true)).rfind("location: body \"wheel\" is held by \"axle\"; allowed: ", 0),
            0u);
  EXPECT_EQ(pin_errors(pin_request("plate", "hand", false)).rfind("location: body \"plate\" is held by \"bolt\"; allowed: ", 0),
            0u);
  EXPECT_EQ(pin_errors(pin_request("load", "load", false)), "frame_id: \"load\", the body's own; allowed: others");
}

TEST(BodyRequests, motionsOfARolloutMoveNoBodies) {
  RolloutGoal goal;
  goal.duration = 0.1;
  goal.rate = 10;
  goal.motion.resize(1);
  goal.motion[0].child_frame_id = "load";
  goal.motion[0].transform.rotation.w = 1;
  try {
    Rollout rollout(goal, {three_bodies(), BoundaryInputs(4)});
    FAIL() << "not refused";
  } catch (const SceneError& error) {
    ASSERT_EQ(error.errors().size(), 1u) << error.what();
    EXPECT_EQ(error.errors()[0], "motion[0].child_frame_id: \"load\"; allowed: none, no frame holds anything");
  }
}

}  // namespace
}  // namespace verlet_cable

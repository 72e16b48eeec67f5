#include "requests/requested.h"

#include <gtest/gtest.h>

#include <limits>

namespace verlet_cable {
namespace {

TEST(Requested, APinHasEveryFieldOfItsMessage) {
  Pin::Request request;
  CableLocation& location = request.location;
  location.cable = "hose";
  location.mode = CableLocation::NEAREST;
  location.node = std::numeric_limits<std::uint32_t>::max();
  location.arc_length = 0.4;
  location.point.header.frame_id = "table";
  location.point.point.x = 1;
  location.point.point.y = 2;
  location.point.point.z = 3;
  request.name = "grip";
  request.frame_id = "hand";
  request.offset.position.x = 4;
  request.offset.position.y = 5;
  request.offset.position.z = 6;
  request.offset.orientation.x = 0.1;
  request.offset.orientation.y = 0.2;
  request.offset.orientation.z = 0.3;
  request.offset.orientation.w = 0.9;
  request.clamp = true;

  const RequestedPin pin = requested_pin(request);
  EXPECT_EQ(pin.place.cable, "hose");
  EXPECT_EQ(pin.place.mode, RequestedPlace::nearest);
  EXPECT_EQ(pin.place.node, 4294967295);
  EXPECT_EQ(pin.place.arc_length, 0.4);
  EXPECT_EQ(pin.place.point, Vector3(1, 2, 3));
  EXPECT_EQ(pin.place.point_frame, "table");
  EXPECT_EQ(pin.name, "grip");
  EXPECT_EQ(pin.frame_id, "hand");
  EXPECT_EQ(pin.offset.position, Vector3(4, 5, 6));
  EXPECT_EQ(pin.offset.orientation.coeffs(), Quaternion(0.9, 0.1, 0.2, 0.3).coeffs());
  EXPECT_TRUE(pin.clamp);
  EXPECT_FALSE(pin.keep_offset);

  request.clamp = false;
  request.keep_offset = true;
  EXPECT_FALSE(requested_pin(request).clamp);
  EXPECT_TRUE(requested_pin(request).keep_offset);
}

TEST(Requested, AMessageOfZerosHasAQuaternionOfZeros) {
  EXPECT_TRUE(requested_pin(Pin::Request()).offset.orientation.coeffs().isZero());
  EXPECT_EQ(requested_pin(Pin::Request()).place.mode, RequestedPlace::at_node);
}

TEST(Requested, AnArcLengthThatIsNotUsedIsTold) {
  CableLocation location;
  EXPECT_EQ(unused_words(location), "");
  location.arc_length = 0.6;
  EXPECT_EQ(unused_words(location), "; mode 0 takes location.node, 0, and not location.arc_length, 0.6 m, which mode 1 takes");
  location.mode = CableLocation::ARC_LENGTH;
  EXPECT_EQ(unused_words(location), "");
}

}  // namespace
}  // namespace verlet_cable

#include "verlet_cable/ros/frame_buffer.h"

#include <gtest/gtest.h>

#include <limits>

namespace verlet_cable {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

ReceivedTransform good() {
  ReceivedTransform received;
  received.transform.header.frame_id = "world";
  received.transform.header.stamp = ros::Time(5);
  received.transform.child_frame_id = "hand";
  received.transform.transform.rotation.w = 1;
  return received;
}

TEST(TransformProblem, NothingIsWrongWithAGoodOne) {
  EXPECT_EQ(transform_problem(good()), "");
  ReceivedTransform fixed = good();
  fixed.is_static = true;
  fixed.transform.header.stamp = ros::Time();
  EXPECT_EQ(transform_problem(fixed), "");
}

TEST(TransformProblem, NamesTheValueThatIsWrong) {
  ReceivedTransform received = good();
  received.transform.transform.translation.y = nan;
  EXPECT_NE(transform_problem(received).find("nan"), std::string::npos);
  received = good();
  received.transform.transform.translation.x = std::numeric_limits<double>::infinity();
  EXPECT_NE(transform_problem(received).find("inf"), std::string::npos);
  received = good();
  received.transform.transform.rotation.w = 0;
  EXPECT_NE(transform_problem(received).find("(0, 0, 0, 0)"), std::string::npos);
  received.transform.transform.rotation.w = nan;
  EXPECT_NE(transform_problem(received), "");
  received.transform.transform.rotation.w = 0.9;
  EXPECT_NE(transform_problem(received).find("0.9"), std::string::npos);
}

TEST(TransformProblem, FramesNeedNamesAndADynamicTransformAStamp) {
  ReceivedTransform received = good();
  received.transform.child_frame_id = "/";
  EXPECT_NE(transform_problem(received), "");
  received = good();
  received.transform.child_frame_id = "/world";
  EXPECT_NE(transform_problem(received), "");
  received = good();
  received.transform.header.stamp = ros::Time();
  EXPECT_NE(transform_problem(received), "");
}

TEST(FrameBuffer, RefusesBadTransformsAndGoesOnWithGoodOnes) {
  FrameBuffer buffer("world");
  ReceivedTransform received = good();
  received.transform.transform.translation.x = 1;
  EXPECT_TRUE(buffer.insert(received));
  received.transform.header.stamp = ros::Time(6);
  received.transform.transform.translation.x = nan;
  EXPECT_FALSE(buffer.insert(received));
  EXPECT_EQ(buffer.refused_count(), 1);
  EXPECT_EQ(buffer.refused().count("hand"), 1U);
  EXPECT_EQ(buffer.newest("hand"), nanoseconds(5));
  received.transform.transform.translation.x = 3;
  EXPECT_TRUE(buffer.insert(received));
  EXPECT_TRUE(buffer.refused().empty());
  EXPECT_DOUBLE_EQ(buffer.pose("hand", nanoseconds(5.5))->position.x(), 2) << "halfway between 1 and 3";
  EXPECT_FALSE(buffer.pose("hand", nanoseconds(6.5)).has_value());
  EXPECT_FALSE(buffer.pose("foot", nanoseconds(5.5)).has_value());
  EXPECT_FALSE(buffer.newest("foot").has_value());
}

TEST(FrameBuffer, ChainsOfStaticAndDynamicTransforms) {
  FrameBuffer buffer("world");
  ReceivedTransform received = good();
  buffer.insert(received);
  received.is_static = true;
  received.transform.header.frame_id = "hand";
  received.transform.child_frame_id = "finger";
  received.transform.transform.translation.z = 0.1;
  buffer.insert(received);
  EXPECT_EQ(buffer.newest("finger"), nanoseconds(5));
  EXPECT_DOUBLE_EQ(buffer.pose("finger", nanoseconds(5))->position.z(), 0.1);
  received.transform.header.frame_id = "world";
  received.transform.child_frame_id = "post";
  buffer.insert(received);
  EXPECT_EQ(buffer.newest("post"), 0) << "does not depend on time";
  buffer.clear();
  EXPECT_FALSE(buffer.newest("finger").has_value());
  EXPECT_EQ(buffer.newest("post"), 0) << "static transforms are not sent again";
}

}  // namespace
}  // namespace verlet_cable

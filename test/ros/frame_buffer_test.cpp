#include "frames/frame_buffer.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "time/ros_time.h"

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

TEST(TransformProblem, StampsThatArithmeticCannotTake) {
  constexpr std::uint32_t last = std::numeric_limits<std::uint32_t>::max();
  ReceivedTransform received = good();
  for (const auto& [stamp, words] : {std::pair<ros::Time, std::string>{{last, 0}, "stamp 4294967295 s"},
                                     {{last, 999999999}, "stamp 4294967295 s"},
                                     {{last - 59, 0}, "allowed: up to 4294967235 s"},
                                     {{5, 0}, ""}}) {
    received.transform.header.stamp = stamp;
    const std::string problem = transform_problem(received);
    EXPECT_EQ(problem.empty(), words.empty());
    EXPECT_NE(problem.find(words), std::string::npos) << problem;
  }
  // Values that a message may have, and ros::Time's constructor would carry over.
  received.transform.header.stamp.sec = 5;
  received.transform.header.stamp.nsec = last;
  EXPECT_NE(transform_problem(received).find("4294967295 ns"), std::string::npos);
  received.transform.header.stamp = ros::Time(1000);
  EXPECT_EQ(transform_problem(received, nanoseconds(998)), "");
  EXPECT_EQ(transform_problem(received, nanoseconds(997.999)),
            "stamp 1000 s, 2.001 s ahead of ROS time; allowed: up to 999 s, 2 s ahead");
  received.is_static = true;
  EXPECT_EQ(transform_problem(received, nanoseconds(1)), "");
}

TEST(RosTime, ConvertsEveryInstant) {
  constexpr std::uint32_t last = std::numeric_limits<std::uint32_t>::max();
  for (const std::uint32_t sec : {0U, 1U, 1U << 31, last})
    for (const std::uint32_t nsec : {0U, 1U, 999999999U})
      EXPECT_EQ(to_ros_time(from_ros_time({sec, nsec})), ros::Time(sec, nsec));
  EXPECT_EQ(to_ros_time(-1), ros::Time(0, 0));
  EXPECT_EQ(to_ros_time(std::numeric_limits<Nanoseconds>::min()), ros::Time(0, 0));
  EXPECT_EQ(to_ros_time(last_ros_time + 1), ros::Time(last, 999999999));
  EXPECT_EQ(to_ros_time(std::numeric_limits<Nanoseconds>::max()), ros::Time(last, 999999999));
}

TEST(FrameBuffer, TakesEveryStampThatItDoesNotRefuse) {
  constexpr std::uint32_t last = std::numeric_limits<std::uint32_t>::max();
  FrameBuffer buffer("world");
  ReceivedTransform received = good();
  for (const std::uint32_t sec : {1U, 1U << 31, last - 61, last - 60, last, 0U, 5U, last - 60}) {
    for (const std::uint32_t nsec : {1U, 999999999U, last}) {
      received.transform.header.stamp.sec = sec;
      received.transform.header.stamp.nsec = nsec;
      EXPECT_NO_THROW(buffer.insert(received));
      for (const Nanoseconds time : {Nanoseconds{0}, Nanoseconds{1}, nanoseconds(5), last_ros_time})
        EXPECT_NO_THROW(buffer.pose("hand", time));
      EXPECT_NO_THROW(buffer.newest("hand"));
    }
  }
}

TEST(FrameBuffer, AStampInTheFutureDoesNotHideWhatComesAfterIt) {
  for (const double ahead : {2.5, 20.0, 59.0, 65.0}) {
    FrameBuffer buffer("world");
    ReceivedTransform received = good();
    received.transform.header.stamp = ros::Time(1000);
    EXPECT_FALSE(buffer.insert(received, nanoseconds(1000)).empty());
    received.transform.header.stamp = ros::Time(1000 + ahead);
    EXPECT_TRUE(buffer.insert(received, nanoseconds(1000)).empty());
    EXPECT_EQ(buffer.refused_count(), 1);
    EXPECT_EQ(buffer.refused().count("hand"), 1U);
    received.transform.header.stamp = ros::Time(1000.1);
    EXPECT_FALSE(buffer.insert(received, nanoseconds(1000.1)).empty());
    EXPECT_EQ(buffer.newest("hand"), nanoseconds(1000.1)) << ahead;
  }
}

TEST(FrameBuffer, KnowsWhetherAnythingCameForALaterTime) {
  FrameBuffer buffer("world");
  EXPECT_FALSE(buffer.reaches_beyond(0));
  buffer.insert(good());
  EXPECT_TRUE(buffer.reaches_beyond(nanoseconds(4.9)));
  EXPECT_FALSE(buffer.reaches_beyond(nanoseconds(5)));
}

TEST(FrameBuffer, AFloodOfNamesIsBounded) {
  FrameBuffer buffer("world");
  ReceivedTransform received = good();
  for (int i = 0; i < 30000; ++i) {
    received.transform.child_frame_id = "f" + std::to_string(i);
    EXPECT_EQ(!buffer.insert(received).empty(), i < 19999) << i;  // and the parent
  }
  EXPECT_LE(buffer.refused().size(), 100U);
  EXPECT_NE(buffer.refused().begin()->second.find("more than 20000 frames"), std::string::npos);
  received = good();
  received.transform.child_frame_id = "f0";
  received.transform.header.stamp = ros::Time(6);
  EXPECT_FALSE(buffer.insert(received).empty()) << "those that are there go on";
}

TEST(FrameBuffer, AFloodOfTransformsIsBoundedAndTakesNoOtherFrameAway) {
  constexpr std::size_t most = 1000;
  FrameBuffer buffer("world", most);
  ReceivedTransform flood = good(), hand = good();
  flood.transform.child_frame_id = "flood";
  std::size_t stored = 0;
  const auto send = [&](ReceivedTransform& received, double time) {
    received.transform.header.stamp = ros::Time(time);
    if (buffer.insert(received).empty()) return false;
    ++stored;
    return true;
  };
  for (int i = 0; i < 20000; ++i) {
    send(flood, 5 + 1e-6 * i);
    EXPECT_TRUE(i % 2000 != 0 || send(hand, 5 + 0.2 * i / 2000)) << i;
  }
  EXPECT_LE(stored, most + 10);
  EXPECT_NE(buffer.refused().at("flood").find("more than 1000 transforms in 60 s"), std::string::npos)
      << buffer.refused().at("flood");
  EXPECT_TRUE(send(flood, 6)) << "one that comes as often as there is room for";
  for (int i = 0; i < 200; ++i) EXPECT_TRUE(send(flood, 66 + 1e-3 * i)) << "what is older than 60 s is forgotten";
}

TEST(StoredTransforms, AreAsManyAsTf2Keeps) {
  StoredTransforms stored(nanoseconds(60), 4);
  stored.add("a", nanoseconds(100));
  stored.add("a", nanoseconds(50));
  stored.add("b", nanoseconds(10));
  EXPECT_TRUE(stored.has_room("b", nanoseconds(9)));
  stored.add("b", nanoseconds(11));
  EXPECT_EQ(stored.size(), 4U);
  EXPECT_EQ(stored.least_interval(), nanoseconds(30));
  EXPECT_FALSE(stored.has_room("a", nanoseconds(129)));
  EXPECT_TRUE(stored.has_room("a", nanoseconds(130)));
  EXPECT_TRUE(stored.has_room("c", nanoseconds(1)));
  stored.add("a", nanoseconds(130));
  EXPECT_EQ(stored.size(), 4U) << "the one at 50 s is gone";
}

TEST(StoredTransforms, AreNotTakenOfNewFramesOnceSilentOnesHaveTwiceAsMany) {
  StoredTransforms stored(nanoseconds(60), 4);
  for (int i = 0; i < 8; ++i) {
    const std::string frame = std::to_string(i);
    ASSERT_FALSE(stored.knows(frame));
    ASSERT_TRUE(stored.has_room(frame, nanoseconds(1))) << i;
    stored.add(frame, nanoseconds(1));
  }
  EXPECT_FALSE(stored.has_room("new", nanoseconds(1)));
  EXPECT_TRUE(stored.has_room("0", nanoseconds(61))) << "known frames go on";
}

TEST(FrameBuffer, RefusesBadTransformsAndGoesOnWithGoodOnes) {
  FrameBuffer buffer("world");
  ReceivedTransform received = good();
  received.transform.transform.translation.x = 1;
  EXPECT_FALSE(buffer.insert(received).empty());
  received.transform.header.stamp = ros::Time(6);
  received.transform.transform.translation.x = nan;
  EXPECT_TRUE(buffer.insert(received).empty());
  EXPECT_EQ(buffer.refused_count(), 1);
  EXPECT_EQ(buffer.refused().count("hand"), 1U);
  EXPECT_EQ(buffer.newest("hand"), nanoseconds(5));
  received.transform.transform.translation.x = 3;
  EXPECT_FALSE(buffer.insert(received).empty());
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

TEST(FrameBuffer, KnowsTheTransformsOnWhichAFrameDepends) {
  FrameBuffer buffer("base");
  const auto insert = [&](const std::string& child, const std::string& parent, double stamp, bool is_static = false) {
    ReceivedTransform received = good();
    received.is_static = is_static;
    received.transform.child_frame_id = child;
    received.transform.header.frame_id = parent;
    received.transform.header.stamp = ros::Time(stamp);
    return !buffer.insert(received).empty();
  };
  using Names = std::set<std::string>;
  EXPECT_EQ(buffer.transforms_of("hand"), Names{});
  EXPECT_TRUE(insert("hand", "arm", 5));
  EXPECT_TRUE(insert("/arm", "/world", 5));
  EXPECT_TRUE(insert("other", "world", 5));
  EXPECT_TRUE(insert("base", "world", 0, true));
  EXPECT_EQ(buffer.transforms_of("hand"), (Names{"arm", "base", "hand"}));
  EXPECT_EQ(buffer.transforms_of("world"), Names{"base"});
  const int version = buffer.tree_version();
  EXPECT_TRUE(insert("hand", "arm", 6));
  EXPECT_EQ(buffer.tree_version(), version);
  EXPECT_TRUE(insert("hand", "other", 7));
  EXPECT_NE(buffer.tree_version(), version);
  EXPECT_EQ(buffer.transforms_of("hand"), (Names{"base", "hand", "other"}));
  // What comes late is not where the frame is now.
  EXPECT_TRUE(insert("hand", "arm", 6.5));
  EXPECT_EQ(buffer.transforms_of("hand"), (Names{"base", "hand", "other"}));
  buffer.see_from("other");
  EXPECT_NE(buffer.tree_version(), version);
  EXPECT_EQ(buffer.transforms_of("hand"), (Names{"hand", "other"}));
  // In a circle
  insert("other", "hand", 8);
  EXPECT_EQ(buffer.transforms_of("hand"), (Names{"hand", "other"}));
}

TEST(FrameBuffer, NamesFramesThatAreStaticAndNot) {
  FrameBuffer buffer("world");
  ReceivedTransform received = good();
  buffer.insert(received);
  buffer.insert(received);
  received.transform.child_frame_id = "post";
  received.is_static = true;
  buffer.insert(received);
  EXPECT_TRUE(buffer.mixed().empty());
  received.transform.child_frame_id = "hand";
  buffer.insert(received);
  EXPECT_EQ(buffer.mixed(), std::set<std::string>{"hand"});
  buffer.clear();
  received.transform.child_frame_id = "post";
  received.is_static = false;
  buffer.insert(received);
  EXPECT_EQ(buffer.mixed(), (std::set<std::string>{"hand", "post"})) << "tf2 keeps what was static through its clear";
}

TEST(FrameBuffer, KnowsTheRootOfATreeWithoutTheFixedFrame) {
  FrameBuffer buffer("world");
  const auto insert = [&](const std::string& parent, const std::string& child, int stamp) {
    ReceivedTransform received = good();
    received.transform.header.frame_id = parent;
    received.transform.child_frame_id = child;
    received.transform.header.stamp = ros::Time(stamp);
    buffer.insert(received);
  };
  insert("arm", "hand", 5);
  insert("base", "arm", 5);
  EXPECT_EQ(buffer.other_root("hand"), "base");
  EXPECT_EQ(buffer.other_root("base"), "base");
  EXPECT_EQ(buffer.other_root("world"), std::nullopt);
  EXPECT_EQ(buffer.other_root("foot"), std::nullopt) << "tf has not had it";
  insert("map", "world", 5);
  EXPECT_EQ(buffer.other_root("hand"), "base");
  insert("map", "base", 5);
  EXPECT_EQ(buffer.other_root("hand"), std::nullopt);
  insert("hand", "base", 6);  // a circle
  EXPECT_NE(buffer.other_root("hand"), std::nullopt);
}

}  // namespace
}  // namespace verlet_cable

// Cameras as nodelets, in the process of the cables.
#include <gtest/gtest.h>
#include <nodelet/loader.h>
#include <ros/ros.h>
#include <sensor_msgs/Image.h>
#include <verlet_cable/CableArray.h>
#include <verlet_cable/CableView.h>

#include <functional>
#include <mutex>
#include <set>

#include "camera/stage_maker.h"
#include "wait_until.h"

namespace {

/// Stamps of the messages of a topic.
template <class Message>
class Stamps {
 public:
  Stamps(ros::NodeHandle& node, const std::string& topic)
      : subscriber_(node.subscribe<Message>(topic, 10, [this](const boost::shared_ptr<const Message>& message) {
          const std::lock_guard<std::mutex> lock(mutex_);
          stamps_.insert(message->header.stamp);
        })) {}
  std::set<ros::Time> all() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return stamps_;
  }

 private:
  mutable std::mutex mutex_;
  std::set<ros::Time> stamps_;  // guarded by mutex_
  ros::Subscriber subscriber_;
};

TEST(CameraNodelet, TwoCamerasSeeTheSameStates) {
  ros::NodeHandle node;
  nodelet::Loader loader;
  ASSERT_TRUE(loader.load("/cables", "verlet_cable/CableNodelet", {}, {}));
  ASSERT_TRUE(loader.load("/first_camera", "verlet_cable/CameraNodelet", {}, {}));
  ASSERT_TRUE(loader.load("/second_camera", "verlet_cable/CameraNodelet", {}, {}));
  const Stamps<sensor_msgs::Image> first(node, "/first_camera/depth/image_raw"), second(node, "/second_camera/rgb/image_raw");
  const auto both = [&] {
    const std::set<ros::Time> others = second.all();
    int count = 0;
    for (const ros::Time& stamp : first.all()) count += static_cast<int>(others.count(stamp));
    return count >= 5;
  };
  EXPECT_TRUE(wait_until(both));
  EXPECT_TRUE(loader.unload("/first_camera"));
  const ros::Time last = *second.all().rbegin();
  EXPECT_TRUE(wait_until([&] { return *second.all().rbegin() > last; }));
}

TEST(CameraNodelet, BadParametersAreRefused) {
  nodelet::Loader loader;
  EXPECT_FALSE(loader.load("/bad_camera", "verlet_cable/CameraNodelet", {}, {}));
}

TEST(CameraNodelet, IsUnloadedWhileItIsLookedAt) {
  ros::NodeHandle node;
  nodelet::Loader loader;
  ASSERT_TRUE(loader.load("/cables", "verlet_cable/CableNodelet", {}, {}));
  for (int round = 0; round < 5; ++round) {
    const Stamps<verlet_cable::CableView> views(node, "/first_camera/truth");
    ASSERT_TRUE(loader.load("/first_camera", "verlet_cable/CameraNodelet", {}, {}));
    EXPECT_TRUE(wait_until([&] { return views.all().size() > 1; }));
    EXPECT_TRUE(loader.unload("/first_camera"));
  }
}

TEST(StageMaker, IsSharedAndMakesAStageOnce) {
  verlet_cable::CameraSettings settings;
  const auto maker = verlet_cable::StageMaker::shared(settings);
  EXPECT_EQ(verlet_cable::StageMaker::shared(settings), maker);
  settings.labels = {"table"};
  EXPECT_NE(verlet_cable::StageMaker::shared(settings), maker);
  const verlet_cable::Moment moment{boost::make_shared<verlet_cable::CableArray>(), nullptr};
  const auto stage = maker->stage(moment, {});
  EXPECT_EQ(maker->stage(moment, {}), stage);
  EXPECT_NE(maker->stage({boost::make_shared<verlet_cable::CableArray>(), nullptr}, {}), stage);
}

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "camera_nodelet_test");
  ros::AsyncSpinner spinner(2);
  spinner.start();
  return RUN_ALL_TESTS();
}

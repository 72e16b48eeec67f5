// The node as a nodelet: loaded in this process, its messages come as the very objects that it has published.
#include <gtest/gtest.h>
#include <nodelet/loader.h>
#include <ros/network.h>
#include <ros/ros.h>
#include <ros/xmlrpc_manager.h>
#include <sensor_msgs/PointCloud2.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>
#include <verlet_cable/CableArray.h>
#include <verlet_cable/RolloutAction.h>
#include <verlet_cable/Step.h>
#include <visualization_msgs/MarkerArray.h>
#include <xmlrpcpp/XmlRpc.h>

#include <array>
#include <atomic>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "wait_until.h"

namespace {

/// The messages of a topic that two subscribers of this process get, by stamp.
template <class Message>
class TwoListeners {
 public:
  TwoListeners(ros::NodeHandle& node, const std::string& topic, std::function<ros::Time(const Message&)> stamp) {
    for (int i = 0; i < 2; ++i) {
      subscribers_[i] = node.subscribe<Message>(topic, 10, [this, i, stamp](const boost::shared_ptr<const Message>& message) {
        const std::lock_guard<std::mutex> lock(mutex_);
        received_[stamp(*message)][i] = message;
      });
    }
  }
  /// Whether some messages came to both; `same`: each as one object.
  bool both(bool& same) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    int count = 0;
    same = true;
    for (const auto& [stamp, messages] : received_) {
      if (!messages[0] || !messages[1]) continue;
      ++count;
      same = same && messages[0] == messages[1];
    }
    return count >= 5;
  }

 private:
  mutable std::mutex mutex_;
  std::map<ros::Time, std::array<boost::shared_ptr<const Message>, 2>> received_;  // guarded by mutex_
  ros::Subscriber subscribers_[2];
};

/// How the connections of this process's topics are made.
bool is_inside_the_process(const std::string& topic) {
  XmlRpc::XmlRpcValue request, response;
  request[0] = ros::this_node::getName();
  std::string host;
  std::uint32_t port = 0;
  ros::network::splitURI(ros::XMLRPCManager::instance()->getServerURI(), host, port);
  XmlRpc::XmlRpcClient client(host.c_str(), static_cast<int>(port), "/");
  if (!client.execute("getBusInfo", request, response)) return false;
  for (int i = 0; i < response[2].size(); ++i) {
    if (std::string(response[2][i][4]) == topic && std::string(response[2][i][3]) == "INTRAPROCESS") return true;
  }
  return false;
}

TEST(Nodelet, MessagesAreNotCopied) {
  ros::NodeHandle node;
  nodelet::Loader loader;
  ASSERT_TRUE(loader.load("/cables", "verlet_cable/CableNodelet", {}, {}));
  TwoListeners<verlet_cable::CableArray> states(node, "/cables/state", [](const auto& m) { return m.header.stamp; });
  TwoListeners<sensor_msgs::PointCloud2> points(node, "/cables/points", [](const auto& m) { return m.header.stamp; });
  TwoListeners<sensor_msgs::PointCloud2> surface(node, "/cables/surface", [](const auto& m) { return m.header.stamp; });
  TwoListeners<visualization_msgs::MarkerArray> markers(node, "/cables/markers",
                                                        [](const auto& m) { return m.markers.at(0).header.stamp; });
  bool same[4];
  ASSERT_TRUE(
      wait_until([&] { return states.both(same[0]) && points.both(same[1]) && surface.both(same[2]) && markers.both(same[3]); }));
  for (const bool one_object : same) EXPECT_TRUE(one_object);
  for (const char* topic : {"/cables/state", "/cables/points", "/cables/surface", "/cables/markers"})
    EXPECT_TRUE(is_inside_the_process(topic)) << topic;
  EXPECT_TRUE(loader.unload("/cables"));
  EXPECT_TRUE(wait_until([] { return !ros::service::exists("/cables/reset", false); }));
}

/// By another thread than the one that serves it: goals, resets and steps are under way, and more come.
TEST(Nodelet, IsUnloadedWhileItIsAsked) {
  ros::NodeHandle node;
  ros::Publisher goals = node.advertise<verlet_cable::RolloutActionGoal>("/cables/rollout/goal", 50);
  std::atomic<int> answers{0};
  const ros::Subscriber results = node.subscribe<verlet_cable::RolloutActionResult>(
      "/cables/rollout/result", 50, [&](const verlet_cable::RolloutActionResultConstPtr&) { ++answers; });
  for (int round = 0; round < 3; ++round) {
    nodelet::Loader loader;
    ASSERT_TRUE(loader.load("/cables", "verlet_cable/CableNodelet", {}, {}));
    ASSERT_TRUE(wait_until([&] { return goals.getNumSubscribers() > 0 && results.getNumPublishers() > 0; }));
    answers = 0;
    std::atomic<bool> ended{false};
    std::atomic<int> resets{0};
    std::vector<std::thread> others;
    others.emplace_back([&] {
      for (int i = 0; !ended; ++i) {
        verlet_cable::RolloutActionGoal goal;
        goal.goal_id.id = std::to_string(round) + "/" + std::to_string(i);
        goal.goal.duration = i % 2 ? 0.01 : 1000;
        goal.goal.rate = 10;
        goals.publish(goal);
        ros::WallDuration(0.001).sleep();
      }
    });
    others.emplace_back([&] {
      std_srvs::Trigger reset;
      while (!ended) resets += ros::service::call("/cables/reset", reset);
    });
    others.emplace_back([&] {
      std_srvs::SetBool pause;
      pause.request.data = true;
      verlet_cable::Step step;
      step.request.steps = 1000000;
      while (!ended) ros::service::call("/cables/pause", pause) && ros::service::call("/cables/step", step);
    });
    EXPECT_TRUE(wait_until([&] { return answers > 0 && resets > 0; }));
    EXPECT_TRUE(loader.unload("/cables"));
    ended = true;
    for (std::thread& other : others) other.join();
    EXPECT_TRUE(wait_until([] { return !ros::service::exists("/cables/reset", false); }));
  }
}

TEST(Nodelet, ABadSceneIsNotLoaded) {
  nodelet::Loader loader;
  EXPECT_FALSE(loader.load("/nothing", "verlet_cable/CableNodelet", {}, {}));
  EXPECT_TRUE(loader.listLoadedNodelets().empty());
}

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "nodelet_test");
  const ros::NodeHandle node;
  ros::AsyncSpinner spinner(1);
  spinner.start();
  return RUN_ALL_TESTS();
}

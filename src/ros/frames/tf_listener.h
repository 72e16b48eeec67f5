#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <tf2_msgs/TFMessage.h>

#include <mutex>
#include <string>
#include <vector>

#include "threads/guarded_queue.h"

namespace verlet_cable {

struct ReceivedTransform {
  geometry_msgs::TransformStamped transform;
  bool is_static = false;
  std::string source{};  ///< the node that sent it
};

/// Subscribed topic `/tf` (tf2_msgs/TFMessage), and `/tf_static`: the frames that hold cables and carry obstacles. Received in a
/// separate thread, so that no message is lost while the node computes.
class TfListener {
 public:
  /// That wait to be judged, here and where they were taken to; more is a flood.
  static constexpr std::size_t most_waiting = 100000;

  explicit TfListener(const ros::NodeHandle& node);

  /// What has come since the last call, in the order of its arrival. `waiting`: how many of before are still there.
  std::vector<ReceivedTransform> take(std::size_t waiting);

 private:
  void receive(const ros::MessageEvent<const tf2_msgs::TFMessage>& event, bool is_static);

  ros::CallbackQueue queue_;
  GuardedQueue guard_;
  ros::NodeHandle node_;
  std::mutex mutex_;
  std::vector<ReceivedTransform> received_;  ///< guarded by mutex_
  std::size_t waiting_ = 0;                  ///< elsewhere, when `take` was called last; guarded by mutex_
  ros::Subscriber dynamic_;
  ros::Subscriber static_;
  ros::AsyncSpinner spinner_;
};

}  // namespace verlet_cable

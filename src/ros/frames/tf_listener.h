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

/// Collects what is sent on `/tf` and `/tf_static` in a thread of its own, so that nothing is missed while the node computes.
/// Nothing is judged here.
class TfListener {
 public:
  explicit TfListener(const ros::NodeHandle& node);

  /// What has come since the last call, in the order of its arrival.
  std::vector<ReceivedTransform> take();

 private:
  void receive(const ros::MessageEvent<const tf2_msgs::TFMessage>& event, bool is_static);

  ros::CallbackQueue queue_;
  GuardedQueue guard_;
  ros::NodeHandle node_;
  std::mutex mutex_;
  std::vector<ReceivedTransform> received_;  ///< guarded by mutex_
  ros::Subscriber dynamic_;
  ros::Subscriber static_;
  ros::AsyncSpinner spinner_;
};

}  // namespace verlet_cable

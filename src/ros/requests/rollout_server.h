#pragma once

#include <actionlib/server/action_server_base.h>
#include <ros/ros.h>
#include <verlet_cable/RolloutAction.h>

#include <functional>
#include <string>

namespace verlet_cable {

/// The topics of an action, as actionlib's own ActionServer has them, but for its use of time: that one adds to the stamps of
/// messages and to ROS time, which throws near the ends of their range, and its status stands when ROS time does.
class RolloutServer : public actionlib::ActionServerBase<RolloutAction> {
 public:
  /// Advertises `name` under the node; answers from `start` on.
  RolloutServer(const ros::NodeHandle& node, const std::string& name, std::function<void(GoalHandle)> accept,
                std::function<void(GoalHandle)> cancel);

 private:
  void initialize() override;
  void publishResult(const actionlib_msgs::GoalStatus& status, const RolloutResult& result) override;
  void publishFeedback(const actionlib_msgs::GoalStatus& status, const RolloutFeedback& feedback) override;
  void publishStatus() override;
  void receive_cancel(const actionlib_msgs::GoalIDConstPtr& goal);

  ros::NodeHandle node_;
  ros::Publisher status_, feedback_, result_;
  ros::Subscriber goals_, cancels_;
  ros::WallTimer timer_;
};

}  // namespace verlet_cable

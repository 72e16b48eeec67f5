#pragma once

#include <ros/callback_queue_interface.h>

#include <functional>

namespace verlet_cable {

/// Runs `action`; what it throws is logged as an error, with `what` was being done, and not passed on.
void run_guarded(const char* what, const std::function<void()>& action);

/// Passes callbacks on to another queue so that none can end the process: the message whose callback throws is dropped, and that
/// is logged as an error. A last resort; what can be wrong with a message is checked where it is read. A timer's callback must
/// be guarded itself, as ROS does not call it again after it threw.
class GuardedQueue : public ros::CallbackQueueInterface {
 public:
  explicit GuardedQueue(ros::CallbackQueueInterface& queue) : queue_(queue) {}

  void addCallback(const ros::CallbackInterfacePtr& callback, std::uint64_t owner = 0) override;
  void removeByID(std::uint64_t owner) override { queue_.removeByID(owner); }

 private:
  ros::CallbackQueueInterface& queue_;
};

}  // namespace verlet_cable

#include "threads/guarded_queue.h"

#include <ros/console.h>

#include <boost/make_shared.hpp>
#include <exception>

namespace verlet_cable {
namespace {

class GuardedCallback : public ros::CallbackInterface {
 public:
  explicit GuardedCallback(ros::CallbackInterfacePtr callback) : callback_(std::move(callback)) {}

  bool ready() override { return callback_->ready(); }

  CallResult call() override {
    CallResult result = Invalid;
    run_guarded("a message", [&] { result = callback_->call(); });
    return result;
  }

 private:
  const ros::CallbackInterfacePtr callback_;
};

}  // namespace

void run_guarded(const char* what, const std::function<void()>& action) {
  try {
    action();
  } catch (const std::exception& error) {
    ROS_ERROR("%s could not be dealt with and is dropped: %s", what, error.what());
  }
}

void GuardedQueue::addCallback(const ros::CallbackInterfacePtr& callback, std::uint64_t owner) {
  queue_.addCallback(boost::make_shared<GuardedCallback>(callback), owner);
}

}  // namespace verlet_cable

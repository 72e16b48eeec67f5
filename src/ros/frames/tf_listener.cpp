#include "frames/tf_listener.h"

#include <utility>

namespace verlet_cable {
namespace {

// As in tf2_ros: a static transform may be sent by each of many nodes at once.
constexpr int tf_queue_size = 1000;

}  // namespace

TfListener::TfListener(const ros::NodeHandle& node) : guard_(queue_), node_(node), spinner_(1, &queue_) {
  node_.setCallbackQueue(&guard_);
  const auto subscribe = [this](const std::string& topic, bool is_static) {
    using Event = const ros::MessageEvent<const tf2_msgs::TFMessage>&;
    return node_.subscribe<Event>(topic, tf_queue_size,
                                  boost::function<void(Event)>([this, is_static](Event event) { receive(event, is_static); }));
  };
  dynamic_ = subscribe("/tf", false);
  static_ = subscribe("/tf_static", true);
  spinner_.start();
}

std::vector<ReceivedTransform> TfListener::take(std::size_t waiting) {
  const std::lock_guard<std::mutex> lock(mutex_);
  waiting_ = waiting + received_.size();
  return std::exchange(received_, {});
}

void TfListener::receive(const ros::MessageEvent<const tf2_msgs::TFMessage>& event, bool is_static) {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (const auto& transform : event.getConstMessage()->transforms) {
    if (waiting_ + received_.size() >= most_waiting) {
      ROS_ERROR_THROTTLE(1, "tf: more than %zu transforms wait to be read; the rest is left out", most_waiting);
      return;
    }
    received_.push_back({transform, is_static, event.getPublisherName()});
  }
}

}  // namespace verlet_cable

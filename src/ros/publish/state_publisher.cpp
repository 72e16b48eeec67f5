#include "publish/state_publisher.h"

#include "publish/conversions.h"
#include "publish/queue_size.h"

namespace verlet_cable {

StatePublisher::StatePublisher(ros::NodeHandle& private_node, const SceneDesc& scene)
    : publisher_(private_node.advertise<CableArray>("state", publisher_queue_size)), frame_id_(scene.frame_id) {}

void StatePublisher::show(const SceneDesc& scene) {
  frame_id_ = scene.frame_id;
}

void StatePublisher::publish(const World& world, const ros::Time& stamp) {
  if (publisher_.getNumSubscribers() == 0) return;
  const auto message = boost::make_shared<CableArray>(to_message(world));
  message->header.stamp = stamp;
  message->header.frame_id = frame_id_;
  publisher_.publish(message);
}

}  // namespace verlet_cable

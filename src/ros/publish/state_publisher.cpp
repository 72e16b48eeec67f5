#include "publish/state_publisher.h"

#include <algorithm>
#include <utility>

#include "publish/conversions.h"
#include "publish/queue_size.h"
#include "verlet_cable/core/body_name.h"

namespace verlet_cable {

StatePublisher::StatePublisher(ros::NodeHandle& private_node, const SceneDesc& scene)
    : publisher_(private_node.advertise<CableArray>("state", publisher_queue_size)), frame_id_(scene.frame_id) {}

void StatePublisher::show(const SceneDesc& scene) {
  frame_id_ = scene.frame_id;
}

void StatePublisher::note_step(const World& world) {
  for (const StatusFinding& found : world.findings().statuses) {
    StepResult::Status& worst = worst_[name_of(world, found.body)];
    worst = std::max(worst, found.status);
  }
}

void StatePublisher::forget_steps() {
  worst_.clear();
}

void StatePublisher::publish(const World& world, const ros::Time& stamp) {
  const std::map<std::string, StepResult::Status> worst = std::exchange(worst_, {});
  if (publisher_.getNumSubscribers() == 0) return;
  const auto message = boost::make_shared<CableArray>(to_message(world));
  const auto raise = [&](auto& part) {
    const auto found = worst.find(part.name);
    if (found != worst.end()) part.status = std::max(part.status, static_cast<std::uint8_t>(found->second));
  };
  for (Cable& cable : message->cables) raise(cable);
  for (Body& body : message->bodies) raise(body);
  message->header.stamp = stamp;
  message->header.frame_id = frame_id_;
  publisher_.publish(message);
}

}  // namespace verlet_cable

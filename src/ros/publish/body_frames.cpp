#include "publish/body_frames.h"

#include <tf2_msgs/TFMessage.h>

#include <utility>

#include "publish/conversions.h"

namespace verlet_cable {
namespace {

constexpr std::uint32_t tf_queue_size = 100;  // as that of tf2_ros

}  // namespace

void BodyFrames::show(const SceneDesc& scene) {
  frame_id_ = scene.frame_id;
  broadcasts_ = scene.broadcast_tf;
}

void BodyFrames::publish(const World& world, const ros::Time& stamp) {
  if (!broadcasts_ || world.bodies().empty() || stamp == std::exchange(last_, stamp)) return;
  if (!publisher_) publisher_ = node_.advertise<tf2_msgs::TFMessage>("/tf", tf_queue_size);
  const auto message = boost::make_shared<tf2_msgs::TFMessage>();
  for (const SimulatedBody& body : world.bodies()) {
    if (body.is_junction || !is_there(world, body)) continue;
    geometry_msgs::TransformStamped& transform = message->transforms.emplace_back();
    transform.header.stamp = stamp;
    transform.header.frame_id = frame_id_;
    transform.child_frame_id = body.name;
    transform.transform.translation = to_vector(body.pose.position);
    transform.transform.rotation = to_quaternion(body.pose.orientation);
  }
  if (!message->transforms.empty()) publisher_.publish(message);
}

}  // namespace verlet_cable

#include "verlet_cable/ros/wrench_publisher.h"

#include <geometry_msgs/WrenchStamped.h>

#include <string_view>
#include <unordered_set>

#include "verlet_cable/ros/conversions.h"
#include "verlet_cable/ros/queue_size.h"

namespace verlet_cable {
namespace {

/// Each topic is registered with the master by a call: those of a large scene come with the next ticks.
const ros::WallDuration longest_registering(0.01);

}  // namespace

WrenchPublisher::WrenchPublisher(ros::NodeHandle& private_node) : node_(private_node, "wrench") {}

void WrenchPublisher::follow_attachments(const World& world) {
  const ros::WallTime deadline = ros::WallTime::now() + longest_registering;
  const auto late = [&] { return ros::WallTime::now() > deadline; };
  std::unordered_set<std::string_view> names;
  for (const Attachment& attachment : world.attachments()) names.insert(attachment.name);
  for (auto entry = publishers_.begin(); entry != publishers_.end() && !late();) {
    entry = names.count(entry->first) == 0 ? publishers_.erase(entry) : std::next(entry);
  }
  for (const Attachment& attachment : world.attachments()) {
    if (publishers_.count(attachment.name) > 0) continue;
    if (late()) return;
    publishers_[attachment.name] = node_.advertise<geometry_msgs::WrenchStamped>(attachment.name, publisher_queue_size);
  }
}

void WrenchPublisher::publish(const World& world, const ros::Time& stamp) {
  follow_attachments(world);
  for (const Attachment& attachment : world.attachments()) {
    const auto publisher = publishers_.find(attachment.name);
    if (publisher == publishers_.end() || publisher->second.getNumSubscribers() == 0 || !attachment.force.allFinite() ||
        !attachment.torque.allFinite())
      continue;
    const auto message = boost::make_shared<geometry_msgs::WrenchStamped>();
    message->header.stamp = stamp;
    message->header.frame_id = world.frames()[attachment.frame];
    message->wrench = wrench_on_frame(attachment, world.frame_pose(attachment.frame));
    publisher->second.publish(message);
  }
}

}  // namespace verlet_cable

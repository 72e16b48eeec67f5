#include "publish/wrench_publisher.h"

#include <geometry_msgs/WrenchStamped.h>

#include <string_view>
#include <vector>

#include "publish/conversions.h"

namespace verlet_cable {

WrenchPublisher::WrenchPublisher(ros::NodeHandle& private_node) : topics_(ros::NodeHandle(private_node, "wrench")) {}

void WrenchPublisher::publish(const World& world, const ros::Time& stamp) {
  std::vector<std::string_view> names;
  for (const Attachment& attachment : world.attachments())
    if (is_named(attachment)) names.push_back(attachment.name);
  topics_.follow(names);
  for (const Attachment& attachment : world.attachments()) {
    if (!is_named(attachment)) continue;
    const ros::Publisher* const topic = topics_.listened(attachment.name);
    if (topic == nullptr) continue;
    // What holds a body is there before the frame that it holds it to.
    if (!world.frame_known(attachment.frame)) continue;
    const Attachment mean = means_.mean(attachment);
    if (!mean.force.allFinite() || !mean.torque.allFinite()) continue;
    const auto message = boost::make_shared<geometry_msgs::WrenchStamped>();
    message->header.stamp = stamp;
    message->header.frame_id = world.frames()[attachment.frame];
    message->wrench = wrench_on_frame(mean, world.frame_pose(attachment.frame));
    topic->publish(message);
  }
  means_.end_tick();
}

}  // namespace verlet_cable

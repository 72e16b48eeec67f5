#include "verlet_cable/ros/wrench_publisher.h"

#include <geometry_msgs/WrenchStamped.h>

#include "verlet_cable/ros/conversions.h"
#include "verlet_cable/ros/queue_size.h"

namespace verlet_cable {

WrenchPublisher::WrenchPublisher(ros::NodeHandle& private_node) : node_(private_node, "wrench") {}

void WrenchPublisher::follow_attachments(const World& world) {
  for (auto entry = publishers_.begin(); entry != publishers_.end();) {
    entry = world.find_attachment(entry->first) < 0 ? publishers_.erase(entry) : std::next(entry);
  }
  for (const Attachment& attachment : world.attachments()) {
    ros::Publisher& publisher = publishers_[attachment.name];
    if (!publisher) publisher = node_.advertise<geometry_msgs::WrenchStamped>(attachment.name, publisher_queue_size);
  }
}

void WrenchPublisher::publish(const World& world, const ros::Time& stamp) {
  follow_attachments(world);
  for (const Attachment& attachment : world.attachments()) {
    const ros::Publisher& publisher = publishers_.at(attachment.name);
    if (publisher.getNumSubscribers() == 0 || !attachment.force.allFinite() || !attachment.torque.allFinite()) continue;
    const auto message = boost::make_shared<geometry_msgs::WrenchStamped>();
    message->header.stamp = stamp;
    message->header.frame_id = world.frames()[attachment.frame];
    message->wrench = wrench_on_frame(attachment, world.frame_pose(attachment.frame));
    publisher.publish(message);
  }
}

}  // namespace verlet_cable

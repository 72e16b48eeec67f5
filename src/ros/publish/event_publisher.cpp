#include "publish/event_publisher.h"

#include <utility>

#include "publish/queue_size.h"
#include "time/ros_time.h"
#include "verlet_cable/core/body_name.h"

namespace verlet_cable {

EventSubject subject_of(const World& world, const Attachment& attachment) {
  return {name_of(world, attachment.body), attachment.name, attachment.node, world.frames()[attachment.frame]};
}

EventPublisher::EventPublisher(ros::NodeHandle& private_node, std::string frame_id)
    : publisher_(private_node.advertise<CableEvent>("events", publisher_queue_size)), frame_id_(std::move(frame_id)) {}

void EventPublisher::publish(std::uint8_t type, Nanoseconds stamp, const EventSubject& subject,
                             const std::string& message) const {
  publish_each(type, stamp, {subject}, message);
}

void EventPublisher::publish_each(std::uint8_t type, Nanoseconds stamp, const std::vector<EventSubject>& subjects,
                                  const std::string& message) const {
  CableEvent event;
  event.header.frame_id = frame_id_;
  event.header.stamp = to_ros_time(stamp);
  event.type = type;
  event.message = message;
  for (const EventSubject& subject : subjects) {
    event.cable = subject.cable;
    event.attachment = subject.attachment;
    event.node = static_cast<std::uint32_t>(subject.node);
    event.other = subject.other;
    publisher_.publish(event);
  }
  if (type == CableEvent::FAULT) {
    ROS_ERROR("%s", message.c_str());
  } else if (type == CableEvent::FRAME_LOST || type == CableEvent::TIME_JUMP || type == CableEvent::BROKE ||
             type == CableEvent::JUMPED || type == CableEvent::LIMIT) {
    ROS_WARN("%s", message.c_str());
  } else {
    ROS_INFO("%s", message.c_str());
  }
}

}  // namespace verlet_cable

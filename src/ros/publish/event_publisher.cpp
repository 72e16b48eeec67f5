#include "publish/event_publisher.h"

#include <utility>

#include "publish/queue_size.h"
#include "time/ros_time.h"

namespace verlet_cable {
namespace {

/// Whether the constants of the message are the types' numbers.
constexpr bool is(EventType type, std::uint8_t constant) {
  return static_cast<std::uint8_t>(type) == constant;
}
static_assert(is(EventType::cut, CableEvent::CUT) && is(EventType::broke, CableEvent::BROKE) &&
              is(EventType::pinned, CableEvent::PINNED) && is(EventType::unpinned, CableEvent::UNPINNED) &&
              is(EventType::frame_lost, CableEvent::FRAME_LOST) && is(EventType::frame_back, CableEvent::FRAME_BACK) &&
              is(EventType::reset, CableEvent::RESET) && is(EventType::time_jump, CableEvent::TIME_JUMP) &&
              is(EventType::fault, CableEvent::FAULT) && is(EventType::joined, CableEvent::JOINED) &&
              is(EventType::limit, CableEvent::LIMIT) && is(EventType::caught, CableEvent::CAUGHT) &&
              is(EventType::released, CableEvent::RELEASED) && is(EventType::jumped, CableEvent::JUMPED));

}  // namespace

EventPublisher::EventPublisher(ros::NodeHandle& private_node, std::string frame_id)
    : publisher_(private_node.advertise<CableEvent>("events", publisher_queue_size)), frame_id_(std::move(frame_id)) {}

void EventPublisher::publish(std::uint8_t type, Nanoseconds stamp, const EventSubject& subject,
                             const std::string& message) const {
  publish_each(type, stamp, {subject}, message);
}

void EventPublisher::publish(const WorldEvent& event, Nanoseconds stamp) const {
  publish(static_cast<std::uint8_t>(event.type), stamp, event.subject, event.message);
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

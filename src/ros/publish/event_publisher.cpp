#include "publish/event_publisher.h"

#include <verlet_cable/Cable.h>

#include <algorithm>
#include <utility>

#include "publish/queue_size.h"
#include "time/ros_time.h"
#include "verlet_cable/core/quoted_text.h"

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
              is(EventType::released, CableEvent::RELEASED) && is(EventType::jumped, CableEvent::JUMPED) &&
              is(EventType::energy, CableEvent::ENERGY) && is(EventType::load_ended, CableEvent::LOAD_ENDED));

constexpr bool is(StepResult::Status status, std::uint8_t constant) {
  return static_cast<std::uint8_t>(status) == constant;
}
using Status = StepResult::Status;
static_assert(is(Status::ok, Cable::OK) && is(Status::jumped, Cable::JUMPED) && is(Status::overstretched, Cable::OVERSTRETCHED) &&
              is(Status::inside_obstacle, Cable::INSIDE_OBSTACLE) && is(Status::not_settled, Cable::NOT_SETTLED) &&
              is(Status::degraded, Cable::DEGRADED) && is(Status::fault, Cable::FAULT));

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

void EventPublisher::publish(const StatusEvent& event, Nanoseconds stamp) const {
  const int node = std::max(event.node, 0);
  if (event.name == name_of(EventType::energy))
    return publish(CableEvent::ENERGY, stamp, {event.cable, {}, 0, {}}, in_quotes(event.cable) + ": " + event.message);
  const std::string message = in_quotes(event.cable) + (event.has_ended ? ": " : " at node " + std::to_string(node) + ": ") +
                              event.name + (event.has_ended ? " " : ": ") + event.message;
  send(CableEvent::STATUS, stamp, {{event.cable, {}, node, event.name}}, message);
  if (event.has_ended)
    ROS_INFO("%s", message.c_str());
  else
    ROS_WARN("%s", message.c_str());
}

void EventPublisher::send(std::uint8_t type, Nanoseconds stamp, const std::vector<EventSubject>& subjects,
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
}

void EventPublisher::publish_each(std::uint8_t type, Nanoseconds stamp, const std::vector<EventSubject>& subjects,
                                  const std::string& message) const {
  send(type, stamp, subjects, message);
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

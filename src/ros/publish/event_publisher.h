#pragma once

#include <ros/ros.h>
#include <verlet_cable/CableEvent.h>

#include <string>
#include <vector>

#include "time/time_grid.h"
#include "world_events/status_log.h"
#include "world_events/world_event.h"

namespace verlet_cable {

/// Topic `events` (verlet_cable/CableEvent): events, each published once. They are logged, too.
class EventPublisher {
 public:
  EventPublisher(ros::NodeHandle& private_node, std::string frame_id);

  void set_frame_id(const std::string& frame_id) { frame_id_ = frame_id; }

  /// `type`: a constant of CableEvent; `stamp`: the simulated time.
  void publish(std::uint8_t type, Nanoseconds stamp, const EventSubject& subject, const std::string& message) const;
  void publish(const WorldEvent& event, Nanoseconds stamp) const;
  void publish(const StatusEvent& event, Nanoseconds stamp) const;
  /// One event about each subject, logged once.
  void publish_each(std::uint8_t type, Nanoseconds stamp, const std::vector<EventSubject>& subjects,
                    const std::string& message) const;

 private:
  void send(std::uint8_t type, Nanoseconds stamp, const std::vector<EventSubject>& subjects, const std::string& message) const;

  ros::Publisher publisher_;
  std::string frame_id_;
};

}  // namespace verlet_cable

#pragma once

#include <ros/ros.h>
#include <verlet_cable/CableEvent.h>

#include <string>
#include <vector>

#include "time/time_grid.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// What an event is about; what does not apply stays empty.
struct EventSubject {
  std::string cable;
  std::string attachment;
  int node = 0;
  std::string other;  ///< the new cable; the frame of FRAME_LOST, FRAME_BACK and JUMPED
};

EventSubject subject_of(const World& world, const Attachment& attachment);

/// The topic `events`. Events are logged, too.
class EventPublisher {
 public:
  EventPublisher(ros::NodeHandle& private_node, std::string frame_id);

  void set_frame_id(const std::string& frame_id) { frame_id_ = frame_id; }

  /// `type`: a constant of CableEvent; `stamp`: the simulated time.
  void publish(std::uint8_t type, Nanoseconds stamp, const EventSubject& subject, const std::string& message) const;
  /// One event about each subject, logged once.
  void publish_each(std::uint8_t type, Nanoseconds stamp, const std::vector<EventSubject>& subjects,
                    const std::string& message) const;

 private:
  ros::Publisher publisher_;
  std::string frame_id_;
};

}  // namespace verlet_cable

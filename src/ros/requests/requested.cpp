#include "requests/requested.h"

#include "verlet_cable/core/number_text.h"

namespace verlet_cable {

static_assert(CableLocation::NODE == RequestedPlace::at_node && CableLocation::ARC_LENGTH == RequestedPlace::at_arc_length &&
              CableLocation::NEAREST == RequestedPlace::nearest);

RequestedPlace requested_place(const CableLocation& location) {
  const geometry_msgs::Point& point = location.point.point;
  return {location.cable,
          location.mode,
          location.node,
          location.arc_length,
          {point.x, point.y, point.z},
          location.point.header.frame_id};
}

RequestedPin requested_pin(const Pin::Request& request) {
  return {requested_place(request.location), request.name,       request.frame_id,
          requested_pose(request.offset),    request.clamp != 0, request.keep_offset != 0};
}

Pose requested_pose(const geometry_msgs::Pose& pose) {
  const geometry_msgs::Quaternion& q = pose.orientation;
  return {{pose.position.x, pose.position.y, pose.position.z}, {q.w, q.x, q.y, q.z}};
}

Vector3 requested_vector(const geometry_msgs::Vector3& vector) {
  return {vector.x, vector.y, vector.z};
}

RequestedLoad requested_load(const std::string& name, const std::string& frame_id, const geometry_msgs::Point& point,
                             const geometry_msgs::Wrench& wrench, double duration, bool on_body) {
  RequestedLoad load;
  load.name = name;
  load.frame_id = frame_id;
  const Vector3 place(point.x, point.y, point.z);
  if (on_body || !(place.array() == 0).all()) load.point = place;
  load.force = requested_vector(wrench.force);
  load.torque = requested_vector(wrench.torque);
  load.duration = duration;
  return load;
}

std::string unused_words(const CableLocation& location) {
  if (location.mode != CableLocation::NODE || location.arc_length == 0) return "";
  return "; mode 0 takes location.node, " + std::to_string(location.node) + ", and not location.arc_length, " +
         number_text(location.arc_length) + " m, which mode 1 takes";
}

}  // namespace verlet_cable

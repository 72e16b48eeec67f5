#pragma once

#include <geometry_msgs/Point.h>
#include <geometry_msgs/Pose.h>
#include <geometry_msgs/Quaternion.h>
#include <geometry_msgs/Transform.h>
#include <geometry_msgs/Vector3.h>

#include <vector>

#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// Of a point or a vector.
template <class Message>
Vector3 vector_of(const Message& message) {
  return {message.x, message.y, message.z};
}

inline Quaternion quaternion_of(const geometry_msgs::Quaternion& message) {
  return {message.w, message.x, message.y, message.z};
}

inline Pose pose_of(const geometry_msgs::Pose& message) {
  return {vector_of(message.position), quaternion_of(message.orientation)};
}

inline Pose pose_of(const geometry_msgs::Transform& message) {
  return {vector_of(message.translation), quaternion_of(message.rotation)};
}

inline std::vector<Vector3> vectors_of(const std::vector<geometry_msgs::Point>& points) {
  std::vector<Vector3> vectors;
  vectors.reserve(points.size());
  for (const geometry_msgs::Point& point : points) vectors.push_back(vector_of(point));
  return vectors;
}

}  // namespace verlet_cable

#include "publish/origin_frame.h"

#include "publish/conversions.h"

namespace verlet_cable {

void OriginFrame::send(const DrawingFrame& frame, const std::string& fixed_frame) {
  if (frame.name == fixed_frame) return;
  geometry_msgs::TransformStamped transform;
  transform.header.frame_id = fixed_frame;
  transform.child_frame_id = frame.name;
  transform.transform.translation = to_vector(frame.origin);
  transform.transform.rotation.w = 1;
  if (transform == sent_) return;
  sent_ = transform;
  transform.header.stamp = ros::Time::now();
  if (!broadcaster_) broadcaster_.emplace();
  broadcaster_->sendTransform(transform);
}

}  // namespace verlet_cable

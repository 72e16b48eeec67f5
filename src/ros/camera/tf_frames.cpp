#include "camera/tf_frames.h"

#include <tf2/exceptions.h>

#include "camera/from_messages.h"

namespace verlet_cable {
namespace {

const ros::Duration memory(60.0);  // as that of the cable node

}  // namespace

TfFrames::TfFrames() : buffer_(memory), listener_(buffer_) {}

std::optional<Pose> TfFrames::pose(const std::string& fixed_frame, const std::string& frame, const ros::Time& time,
                                   std::string& why) {
  const auto known = known_.find(frame);
  if (known != known_.end() && known->second.time == time && known->second.fixed_frame == fixed_frame) return known->second.pose;
  try {
    const Pose pose = pose_of(buffer_.lookupTransform(fixed_frame, frame, time).transform);
    known_[frame] = {fixed_frame, time, pose};
    return pose;
  } catch (const tf2::TransformException& problem) {
    why = problem.what();
    return std::nullopt;
  }
}

}  // namespace verlet_cable

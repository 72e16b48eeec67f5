#pragma once

#include <ros/ros.h>

#include "camera/image_topics.h"

namespace verlet_cable {

/// All topics of images, with one stamp. What nobody listens to is not computed.
class Images {
 public:
  Images(ros::NodeHandle& node, const CameraSettings& settings, const ros::SubscriberStatusCallback& changed);

  bool are_wanted() const;
  void publish(const Shot& shot) const;

 private:
  view::SensorModel sensor_;
  std::uint64_t seed_;
  DepthEncoding depth_encoding_;
  DepthTopic depth_;
  ColorTopic color_;
  MaskTopic mask_;
  CloudTopic cloud_;
  TruthTopic truth_;
};

}  // namespace verlet_cable

#pragma once

#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>

#include <memory>
#include <string>
#include <vector>

#include "camera/camera_settings.h"
#include "verlet_cable/view/camera_model.h"

namespace verlet_cable {

/// Topic `camera_info` (sensor_msgs/CameraInfo): the intrinsics and the distortion of the images, with their stamp; also beside
/// each image, `depth/camera_info`, `rgb/camera_info` and `mask/camera_info`, where rviz and image_transport look for it. With
/// `camera_info_topic`, those that are received there; until then there are no images.
class Intrinsics {
 public:
  Intrinsics(ros::NodeHandle& node, const CameraSettings& settings, const ros::SubscriberStatusCallback& changed);

  /// None where a driver has said nothing yet that can be used.
  std::shared_ptr<const view::Lens> lens() const { return lens_; }
  bool are_wanted() const;
  const std::string& awaited_topic() const { return topic_; }
  void publish(const ros::Time& stamp) const;

 private:
  void receive(const sensor_msgs::CameraInfoConstPtr& info);
  /// Each problem as it comes, and again while it lasts.
  void warn_of(const std::string& problem);

  const std::string frame_;
  const double near_, far_;
  const std::string topic_;                 ///< of the driver; empty: none
  std::vector<ros::Publisher> publishers_;  ///< but for a topic that the driver publishes itself
  ros::Subscriber subscriber_;
  std::string last_problem_;
  ros::WallTime next_warning_;  ///< of that
  sensor_msgs::CameraInfo info_;
  std::shared_ptr<const view::Lens> lens_;
};

}  // namespace verlet_cable

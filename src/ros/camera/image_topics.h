#pragma once

#include <ros/ros.h>
#include <sensor_msgs/Image.h>
#include <verlet_cable/CableArray.h>

#include <string>

#include "camera/camera_settings.h"
#include "verlet_cable/view/render.h"

namespace verlet_cable {

/// What goes with every message of one image.
struct Shot {
  std_msgs::Header header;  ///< the stamp of the state, in the optical frame
  const CableArray& state;
  const view::Stage& stage;
  const view::Lens& lens;
  Pose pose;  ///< of the optical frame in the fixed frame
};

/// A topic of a camera.
class ImageTopic {
 public:
  bool is_wanted() const { return publisher_.getNumSubscribers() > 0; }

 protected:
  static constexpr std::uint32_t queue_size = 5;
  ros::Publisher publisher_;
};

/// Topic `depth/image_raw` (sensor_msgs/Image): 32FC1, depth along the optical axis [m], NaN where there is none; with
/// `depth_encoding` 16UC1 in mm, and 0 where there is none.
class DepthTopic : public ImageTopic {
 public:
  DepthTopic(ros::NodeHandle& node, DepthEncoding encoding, const ros::SubscriberStatusCallback& changed);
  /// `depth`: 32FC1; rounded here where it is published in mm.
  void publish(const sensor_msgs::ImagePtr& depth) const;

 private:
  DepthEncoding encoding_;
};

/// Topic `rgb/image_raw` (sensor_msgs/Image): the colors of the scene as rgb8, with light and shadows.
class ColorTopic : public ImageTopic {
 public:
  ColorTopic(ros::NodeHandle& node, const ros::SubscriberStatusCallback& changed);
  void publish(const sensor_msgs::ImagePtr& rgb) const;
};

/// Topic `mask/image_raw` (sensor_msgs/Image): 16UC1, what is seen in each pixel: 0 background, 1 + `cable_id` of the topic
/// `points` of the cable node, then bodies, then what `labels` names, then all else: obstacles, then links of the robot. `truth`
/// has the names.
class MaskTopic : public ImageTopic {
 public:
  MaskTopic(ros::NodeHandle& node, const ros::SubscriberStatusCallback& changed);
  void publish(const sensor_msgs::ImagePtr& mask) const;
};

/// Topic `points` (sensor_msgs/PointCloud2): the depth image as points, organized as its pixels are: x, y, z [m] in the optical
/// frame, NaN where there is no depth; rgb; and label, the value of the mask.
class CloudTopic : public ImageTopic {
 public:
  CloudTopic(ros::NodeHandle& node, const ros::SubscriberStatusCallback& changed);
  void publish(const view::Lens& lens, const sensor_msgs::Image& depth, const sensor_msgs::Image& rgb,
               const sensor_msgs::Image& mask) const;
};

/// Topic `truth` (verlet_cable/CableView): where the nodes of all cables are in the optical frame and in the image, which of them
/// are seen, and the names of the values in masks.
class TruthTopic : public ImageTopic {
 public:
  TruthTopic(ros::NodeHandle& node, const ros::SubscriberStatusCallback& changed);
  void publish(const Shot& shot) const;
};

}  // namespace verlet_cable

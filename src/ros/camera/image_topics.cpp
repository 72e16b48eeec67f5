#include "camera/image_topics.h"

#include <sensor_msgs/PointCloud2.h>
#include <sensor_msgs/image_encodings.h>
#include <sensor_msgs/point_cloud2_iterator.h>
#include <verlet_cable/CableView.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "camera/pixels.h"
#include "publish/conversions.h"

namespace verlet_cable {
namespace {

/// One point as it lies in the cloud's data: the fields of the cloud, in this order.
struct PointRecord {
  float x, y, z;
  std::uint8_t b, g, r, unused;
  std::uint32_t label;
};

}  // namespace

DepthTopic::DepthTopic(ros::NodeHandle& node, DepthEncoding encoding, const ros::SubscriberStatusCallback& changed)
    : encoding_(encoding) {
  publisher_ = node.advertise<sensor_msgs::Image>("depth/image_raw", queue_size, changed, changed);
}

void DepthTopic::publish(const sensor_msgs::ImagePtr& depth) const {
  publisher_.publish(encoding_ == DepthEncoding::metres ? depth : in_millimetres(*depth));
}

ColorTopic::ColorTopic(ros::NodeHandle& node, const ros::SubscriberStatusCallback& changed) {
  publisher_ = node.advertise<sensor_msgs::Image>("rgb/image_raw", queue_size, changed, changed);
}

void ColorTopic::publish(const sensor_msgs::ImagePtr& rgb) const {
  publisher_.publish(rgb);
}

MaskTopic::MaskTopic(ros::NodeHandle& node, const ros::SubscriberStatusCallback& changed) {
  publisher_ = node.advertise<sensor_msgs::Image>("mask/image_raw", queue_size, changed, changed);
}

void MaskTopic::publish(const sensor_msgs::ImagePtr& mask) const {
  publisher_.publish(mask);
}

CloudTopic::CloudTopic(ros::NodeHandle& node, const ros::SubscriberStatusCallback& changed) {
  publisher_ = node.advertise<sensor_msgs::PointCloud2>("points", queue_size, changed, changed);
}

void CloudTopic::publish(const view::Lens& lens, const sensor_msgs::Image& depth, const sensor_msgs::Image& rgb,
                         const sensor_msgs::Image& mask) const {
  using sensor_msgs::PointField;
  const auto cloud = boost::make_shared<sensor_msgs::PointCloud2>();
  cloud->header = depth.header;
  sensor_msgs::PointCloud2Modifier(*cloud).setPointCloud2Fields(5, "x", 1, PointField::FLOAT32, "y", 1, PointField::FLOAT32, "z",
                                                                1, PointField::FLOAT32, "rgb", 1, PointField::FLOAT32, "label", 1,
                                                                PointField::UINT32);
  cloud->height = depth.height;
  cloud->width = depth.width;
  cloud->is_dense = false;
  cloud->point_step = sizeof(PointRecord);
  cloud->row_step = cloud->point_step * cloud->width;
  cloud->data.resize(std::size_t{cloud->row_step} * cloud->height);
  std::uint8_t* out = cloud->data.data();
  std::size_t pixel = 0;
  for (int row = 0; row < lens.model().height; ++row)
    for (int column = 0; column < lens.model().width; ++column, ++pixel, out += sizeof(PointRecord)) {
      const double z = pixel_of<float>(depth, pixel);
      const std::array<double, 2>& sight = lens.sight(column, row);
      const std::uint8_t* const color = &rgb.data[3 * pixel];
      const PointRecord record{static_cast<float>(z * sight[0]),
                               static_cast<float>(z * sight[1]),
                               static_cast<float>(z),
                               color[2],
                               color[1],
                               color[0],
                               0,
                               pixel_of<std::uint16_t>(mask, pixel)};
      std::memcpy(out, &record, sizeof(record));
    }
  publisher_.publish(cloud);
}

TruthTopic::TruthTopic(ros::NodeHandle& node, const ros::SubscriberStatusCallback& changed) {
  publisher_ = node.advertise<CableView>("truth", queue_size, changed, changed);
}

void TruthTopic::publish(const Shot& shot) const {
  const auto message = boost::make_shared<CableView>();
  message->header = shot.header;
  message->labels = view::labels(shot.stage.drawing());
  for (const view::CableTruth& cable : view::find_truth(shot.stage, shot.lens.model(), shot.pose)) {
    if (cable.positions.empty()) continue;  // it waits for its frames
    message->cables.push_back(cable.name);
    message->first.push_back(static_cast<std::uint32_t>(message->positions.size()));
    for (const Vector3& position : cable.positions) message->positions.push_back(to_point(position));
    for (const double u : cable.u) message->u.push_back(static_cast<float>(u));
    for (const double v : cable.v) message->v.push_back(static_cast<float>(v));
    message->visible.insert(message->visible.end(), cable.visible.begin(), cable.visible.end());
  }
  publisher_.publish(message);
}

}  // namespace verlet_cable

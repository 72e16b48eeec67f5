#pragma once

#include <ros/time.h>
#include <sensor_msgs/PointCloud2.h>
#include <sensor_msgs/point_cloud2_iterator.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

namespace verlet_cable {

/// What is too large for a float is the largest there is, not infinite.
inline float to_float(double number) {
  constexpr double largest = std::numeric_limits<float>::max();
  return static_cast<float>(std::clamp(number, -largest, largest));
}

/// A cloud of height 1. `Record` is a point as it lies in the cloud's data; `fields` are those of
/// PointCloud2Modifier::setPointCloud2Fields, in the record's order.
template <typename Record, typename... Fields>
sensor_msgs::PointCloud2Ptr make_point_cloud(const std::string& frame_id, const ros::Time& stamp,
                                             const std::vector<Record>& points, Fields... fields) {
  auto cloud = boost::make_shared<sensor_msgs::PointCloud2>();
  cloud->header.stamp = stamp;
  cloud->header.frame_id = frame_id;
  // A name, a count and a type each
  sensor_msgs::PointCloud2Modifier(*cloud).setPointCloud2Fields(sizeof...(fields) / 3, fields...);
  cloud->height = 1;
  cloud->width = static_cast<std::uint32_t>(points.size());
  cloud->is_dense = true;
  cloud->point_step = sizeof(Record);
  cloud->row_step = cloud->point_step * cloud->width;
  cloud->data.resize(cloud->row_step);
  if (!points.empty()) std::memcpy(cloud->data.data(), points.data(), cloud->data.size());
  return cloud;
}

}  // namespace verlet_cable

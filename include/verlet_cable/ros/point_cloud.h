#pragma once

#include <ros/time.h>
#include <sensor_msgs/PointCloud2.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace verlet_cable {

/// A cloud of height 1. `Record` is a point as it lies in the cloud's data: four bytes a field, all in the order of `fields`.
template <typename Record>
sensor_msgs::PointCloud2Ptr make_point_cloud(const std::string& frame_id, const ros::Time& stamp,
                                             const std::vector<sensor_msgs::PointField>& fields,
                                             const std::vector<Record>& points) {
  auto cloud = boost::make_shared<sensor_msgs::PointCloud2>();
  cloud->header.stamp = stamp;
  cloud->header.frame_id = frame_id;
  cloud->fields = fields;
  cloud->height = 1;
  cloud->width = static_cast<std::uint32_t>(points.size());
  cloud->is_dense = true;
  cloud->point_step = sizeof(Record);
  cloud->row_step = cloud->point_step * cloud->width;
  cloud->data.resize(cloud->row_step);
  if (!points.empty()) std::memcpy(cloud->data.data(), points.data(), cloud->data.size());
  return cloud;
}

/// The field of a record that comes after `before` others.
inline sensor_msgs::PointField point_field(const std::string& name, std::uint8_t type, std::uint32_t before) {
  sensor_msgs::PointField field;
  field.name = name;
  field.offset = 4 * before;
  field.datatype = type;
  field.count = 1;
  return field;
}

}  // namespace verlet_cable

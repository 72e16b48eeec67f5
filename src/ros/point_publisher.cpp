#include "verlet_cable/ros/point_publisher.h"

#include <sensor_msgs/PointCloud2.h>
#include <sensor_msgs/point_cloud2_iterator.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <vector>

#include "verlet_cable/ros/conversions.h"
#include "verlet_cable/ros/queue_size.h"

namespace verlet_cable {
namespace {

/// One point as it lies in the cloud's data: the fields below, in this order.
struct PointRecord {
  float x, y, z, rgb, tension;
  std::uint32_t cable_id, node_id;
  float s;
};

void set_fields(sensor_msgs::PointCloud2& cloud) {
  using sensor_msgs::PointField;
  sensor_msgs::PointCloud2Modifier(cloud).setPointCloud2Fields(8, "x", 1, PointField::FLOAT32, "y", 1, PointField::FLOAT32, "z",
                                                               1, PointField::FLOAT32, "rgb", 1, PointField::FLOAT32, "tension",
                                                               1, PointField::FLOAT32, "cable_id", 1, PointField::UINT32,
                                                               "node_id", 1, PointField::UINT32, "s", 1, PointField::FLOAT32);
}

void append_points(const SimulatedCable& cable, std::uint32_t cable_id, const std::vector<std_msgs::ColorRGBA>& colors,
                   std::vector<PointRecord>& points) {
  const std::vector<double> arc_length = cable.model.arc_length();
  for (int node = 0; node < cable.model.nodes(); ++node) {
    const Eigen::Vector3f position = cable.state.positions[node].cast<float>();
    const double tension = cable.state.tension[std::min(node, cable.model.segments() - 1)];
    points.push_back({position.x(), position.y(), position.z(), packed_rgb(colors[node]), static_cast<float>(tension), cable_id,
                      static_cast<std::uint32_t>(node), static_cast<float>(arc_length[node])});
  }
}

}  // namespace

PointPublisher::PointPublisher(ros::NodeHandle& private_node, const SceneDesc& scene)
    : publisher_(private_node.advertise<sensor_msgs::PointCloud2>("points", publisher_queue_size)),
      frame_id_(scene.frame_id),
      colors_(scene) {}

void PointPublisher::show(const SceneDesc& scene) {
  frame_id_ = scene.frame_id;
  colors_ = ColorScale(scene);
}

void PointPublisher::publish(const World& world, const ros::Time& stamp) {
  if (publisher_.getNumSubscribers() == 0) return;
  std::vector<PointRecord> points;
  const std::vector<std::vector<double>> contact_forces = colors_.contact_forces(world);
  for (std::size_t id = 0; id < world.cables().size(); ++id) {
    const SimulatedCable& cable = world.cables()[id];
    if (is_finite(cable))
      append_points(cable, static_cast<std::uint32_t>(id), colors_.node_colors(cable, contact_forces[id]), points);
  }
  const auto cloud = boost::make_shared<sensor_msgs::PointCloud2>();
  cloud->header.stamp = stamp;
  cloud->header.frame_id = frame_id_;
  set_fields(*cloud);
  cloud->height = 1;
  cloud->width = static_cast<std::uint32_t>(points.size());
  cloud->is_dense = true;
  cloud->row_step = cloud->point_step * cloud->width;
  cloud->data.resize(cloud->row_step);
  if (!points.empty()) std::memcpy(cloud->data.data(), points.data(), cloud->data.size());
  publisher_.publish(cloud);
}

}  // namespace verlet_cable

#include "publish/point_publisher.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "publish/conversions.h"
#include "publish/point_cloud.h"
#include "publish/queue_size.h"

namespace verlet_cable {
namespace {

/// One point as it lies in the cloud's data: the fields below, in this order.
struct PointRecord {
  float x, y, z, rgb, tension;
  std::uint32_t cable_id, node_id;
  float s;
};

void append_points(const SimulatedCable& cable, std::uint32_t cable_id, const std::vector<std_msgs::ColorRGBA>& colors,
                   const Vector3& origin, std::vector<PointRecord>& points) {
  const std::vector<double> arc_length = cable.state.arc_length();
  for (int node = 0; node < cable.state.nodes(); ++node) {
    const Vector3 p = cable.state.positions[node] - origin;
    const double tension = cable.state.tension[std::min(node, cable.state.segments() - 1)];
    points.push_back({to_float(p.x()), to_float(p.y()), to_float(p.z()), packed_rgb(colors[node]), to_float(tension), cable_id,
                      static_cast<std::uint32_t>(node), to_float(arc_length[node])});
  }
}

PointRecord record(const Vector3& p, const std::array<double, 4>& color, double tension, std::size_t id, std::size_t node) {
  return {to_float(p.x()),
          to_float(p.y()),
          to_float(p.z()),
          packed_rgb(to_color(color)),
          to_float(tension),
          static_cast<std::uint32_t>(id),
          static_cast<std::uint32_t>(node),
          0};
}

/// Nets count on from the cables, particles from the nets.
void append_nets_and_particles(const World& world, const Vector3& origin, std::vector<PointRecord>& points) {
  std::size_t id = world.cables().size();
  for (const SimulatedNet& net : world.nets()) {
    const std::vector<double> tension = node_tension(net);
    for (std::size_t node = 0; is_finite(net) && node < tension.size(); ++node)
      points.push_back(record(net.state.positions[node] - origin, net.model.color, tension[node], id, node));
    ++id;
  }
  for (const SimulatedParticle& particle : world.particles()) {
    if (is_finite(particle)) points.push_back(record(particle.position - origin, particle.desc.color, 0, id, 0));
    ++id;
  }
}

}  // namespace

PointPublisher::PointPublisher(ros::NodeHandle& private_node, const SceneDesc&, const DrawingFrame& frame)
    : publisher_(private_node.advertise<sensor_msgs::PointCloud2>("points", publisher_queue_size)), frame_(frame) {}

void PointPublisher::show(const SceneDesc&, const DrawingFrame& frame) {
  frame_ = frame;
}

void PointPublisher::publish(const World& world, const ColorScale& colors, const ros::Time& stamp) {
  if (publisher_.getNumSubscribers() == 0) return;
  std::vector<PointRecord> points;
  const std::vector<std::vector<double>> contact_forces = colors.contact_forces(world);
  for (std::size_t id = 0; id < world.cables().size(); ++id) {
    const SimulatedCable& cable = world.cables()[id];
    if (is_finite(cable))
      append_points(cable, static_cast<std::uint32_t>(id), colors.node_colors(cable, contact_forces[id]), frame_.origin, points);
  }
  append_nets_and_particles(world, frame_.origin, points);
  using sensor_msgs::PointField;
  publisher_.publish(make_point_cloud(frame_.name, stamp, points, "x", 1, PointField::FLOAT32, "y", 1, PointField::FLOAT32, "z",
                                      1, PointField::FLOAT32, "rgb", 1, PointField::FLOAT32, "tension", 1, PointField::FLOAT32,
                                      "cable_id", 1, PointField::UINT32, "node_id", 1, PointField::UINT32, "s", 1,
                                      PointField::FLOAT32));
}

}  // namespace verlet_cable

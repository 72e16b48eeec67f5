#include "publish/surface_publisher.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "publish/conversions.h"
#include "publish/point_cloud.h"
#include "publish/queue_size.h"
#include "verlet_cable/core/cable_materials.h"

namespace verlet_cable {
namespace {

constexpr int sides = 12;  // points around a cable
constexpr double most_points = 100000;

/// One point as it lies in the cloud's data: the fields below, in this order.
struct PointRecord {
  float x, y, z, rgb;
  std::uint32_t cable_id;
};

double smallest_radius(const SimulatedCable& cable) {
  return CableMaterials(cable).smallest([](const MaterialDesc& material) { return material.radius; });
}

/// Rings of a cable, if they are as far apart as the points of a ring, times `coarseness`.
int ring_count(const SimulatedCable& cable, double coarseness) {
  const double spacing = coarseness * 2 * M_PI * smallest_radius(cable) / sides;
  return static_cast<int>(std::clamp(std::floor(cable.state.length() / spacing), 1.0, most_points / sides));
}

/// By how much rings must be further apart than the points of a ring.
double find_coarseness(const World& world) {
  double points = 0;
  for (const SimulatedCable& cable : world.cables())
    points += cable.state.length() / (2 * M_PI * smallest_radius(cable) / sides) * sides;
  return std::max(1.0, points / most_points);
}

void append_points(const SimulatedCable& cable, std::uint32_t cable_id, double coarseness,
                   const std::vector<std_msgs::ColorRGBA>& colors, const Vector3& origin, std::vector<PointRecord>& points) {
  const std::vector<Quaternion> orientations = segment_orientations(cable.state);
  const std::vector<double> arc_length = cable.state.arc_length();
  const CableMaterials materials(cable);
  const int rings = ring_count(cable, coarseness);
  int i = 0;
  for (int ring = 0; ring < rings; ++ring) {
    const double s = (ring + 0.5) / rings * arc_length.back();
    while (i + 1 < cable.state.segments() && arc_length[i + 1] < s) ++i;
    const double part = std::clamp((s - arc_length[i]) / cable.state.rest_lengths[i], 0.0, 1.0);
    const Vector3 center = cable.state.positions[i] + part * (cable.state.positions[i + 1] - cable.state.positions[i]);
    const float rgb = packed_rgb(colors[part < 0.5 ? i : i + 1]);
    for (int side = 0; side < sides; ++side) {
      const double angle = 2 * M_PI * side / sides;
      const Vector3 spoke = materials[i].radius * Vector3(0, std::cos(angle), std::sin(angle));
      const Vector3 point = center - origin + orientations[i] * spoke;
      points.push_back({to_float(point.x()), to_float(point.y()), to_float(point.z()), rgb, cable_id});
    }
  }
}

}  // namespace

SurfacePublisher::SurfacePublisher(ros::NodeHandle& private_node, const SceneDesc&, const DrawingFrame& frame)
    : publisher_(private_node.advertise<sensor_msgs::PointCloud2>("surface", publisher_queue_size)), frame_(frame) {}

void SurfacePublisher::show(const SceneDesc&, const DrawingFrame& frame) {
  frame_ = frame;
}

void SurfacePublisher::publish(const World& world, const ColorScale& colors, const ros::Time& stamp) {
  if (publisher_.getNumSubscribers() == 0) return;
  const double coarseness = find_coarseness(world);
  std::vector<PointRecord> points;
  const std::vector<std::vector<double>> contact_forces = colors.contact_forces(world);
  for (std::size_t id = 0; id < world.cables().size(); ++id) {
    const SimulatedCable& cable = world.cables()[id];
    if (!is_finite(cable)) continue;
    append_points(cable, static_cast<std::uint32_t>(id), coarseness, colors.node_colors(cable, contact_forces[id]), frame_.origin,
                  points);
  }
  using sensor_msgs::PointField;
  publisher_.publish(make_point_cloud(frame_.name, stamp, points, "x", 1, PointField::FLOAT32, "y", 1, PointField::FLOAT32, "z",
                                      1, PointField::FLOAT32, "rgb", 1, PointField::FLOAT32, "cable_id", 1, PointField::UINT32));
}

}  // namespace verlet_cable

#include "publish/guide_markers.h"

#include <algorithm>
#include <cmath>

#include "publish/conversions.h"
#include "verlet_cable/core/cable_materials.h"

namespace verlet_cable {
namespace {

using visualization_msgs::Marker;

constexpr double ring_size = 3, ring_width = 1.2;   // of a ring's radius and its width to the cable's radius
constexpr double closed_gap = 0.6, open_gap = 2.4;  // [rad] of a clip's ring
constexpr int ring_points = 24;
constexpr double groove_width = 2.5, rim_height = 2, rim_width = 0.6;  // of a wheel, to the cable's radius

Marker make_marker(int type, const Pose& pose) {
  Marker marker;
  marker.type = type;
  marker.pose = to_pose(pose);
  marker.color.r = 0.2f;
  marker.color.g = 0.45f;
  marker.color.b = 0.75f;
  marker.color.a = 1;
  return marker;
}

/// About the pose's x; `gap` [rad] is missing, on the side of its z.
Marker make_ring(const Pose& pose, double radius, double width, double gap) {
  Marker ring = make_marker(Marker::LINE_STRIP, pose);
  ring.scale.x = width;
  for (int i = 0; i <= ring_points; ++i) {
    const double angle = 0.5 * gap + (2 * M_PI - gap) * i / ring_points;
    ring.points.push_back(to_point(radius * Vector3(0, std::sin(angle), std::cos(angle))));
  }
  return ring;
}

/// About the pose's z.
Marker make_disc(const Pose& pose, double height, double radius, double width) {
  Marker disc = make_marker(Marker::CYLINDER, pose * Pose{{0, 0, height}, Quaternion::Identity()});
  disc.scale.x = disc.scale.y = 2 * radius;
  disc.scale.z = width;
  return disc;
}

/// [m] Of the cable, whether the guide holds it or not.
double cable_radius(const World& world, const SimulatedGuide& guide) {
  const int cable = find(world.cables(), guide.cable);
  return cable < 0 ? 0 : CableMaterials(world.cables()[cable]).largest_radius();
}

}  // namespace

std::vector<Marker> guide_markers(const World& world, int index) {
  const SimulatedGuide& guide = world.guides()[index];
  const double radius = cable_radius(world, guide);
  if (!world.frame_known(guide.frame) || !(radius > 0)) return {};
  Pose pose = world.frame_pose(guide.frame) * guide.pose;
  if (guide.type == GuideDesc::Type::sheave) {
    const double side = 0.5 * (groove_width + rim_width) * radius;
    const auto rim = [&](double height) {
      return make_disc(pose, height, guide.radius + rim_height * radius, rim_width * radius);
    };
    return {make_disc(pose, 0, std::max(guide.radius - radius, 0.5 * guide.radius), groove_width * radius), rim(-side),
            rim(side)};
  }
  double gap = guide.type == GuideDesc::Type::clip ? open_gap : 0;
  for (const Attachment& attachment : world.attachments()) {
    if (attachment.guide != index) continue;
    const std::vector<Vector3>& nodes = world.cables()[attachment.body.index].state.positions;
    const Vector3 along = nodes[attachment.node + 1] - nodes[attachment.node - 1];
    if (along.allFinite() && along.norm() > 0)
      pose.orientation = Quaternion::FromTwoVectors(pose.orientation * Vector3::UnitX(), along) * pose.orientation;
    if (gap > 0) gap = closed_gap;
  }
  return {make_ring(pose, ring_size * radius, ring_width * radius, gap)};
}

}  // namespace verlet_cable

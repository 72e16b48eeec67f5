#include "exact_rays.h"

#include <algorithm>
#include <cmath>

namespace verlet_cable::view {
namespace {

double distance_to_tube(const Tube& tube, const Vector3& point) {
  double nearest = infinity;
  for (std::size_t i = 0; i + 1 < tube.centers.size(); ++i) {
    const Vector3 axis = tube.centers[i + 1] - tube.centers[i];
    const double part = std::clamp((point - tube.centers[i]).dot(axis) / axis.squaredNorm(), 0.0, 1.0);
    const double radius = tube.radii[tube.radii.size() == 1 ? 0 : i];
    nearest = std::min(nearest, (point - tube.centers[i] - part * axis).norm() - radius);
  }
  return nearest;
}

}  // namespace

double ExactRays::distance(const Thing& thing, const Vector3& point) const {
  double nearest = infinity;
  for (const Tube& tube : thing.tubes) nearest = std::min(nearest, distance_to_tube(tube, point));
  for (const Part& part : thing.parts) {
    const Pose inside = (thing.pose * part.pose).inverse() * Pose{point, Quaternion::Identity()};
    nearest = std::min(nearest, closest_point(part.shape, inside.position).distance);
  }
  return nearest;
}

ExactRays::Hit ExactRays::cast(const Vector3& eye, const Vector3& direction, double near, double far) const {
  constexpr double reached = 1e-9;  // [m]
  const double length = direction.norm();
  Hit hit;
  hit.depth = near;
  std::vector<double> before(drawing_.things.size(), infinity);
  for (int step = 0; step < 20000 && hit.depth <= far; ++step) {
    hit.point = eye + hit.depth * direction;
    double nearest = infinity;
    for (std::size_t i = 0; i < drawing_.things.size(); ++i) {
      const double away = distance(drawing_.things[i], hit.point);
      // What is being left was passed by.
      if (away > before[i]) hit.clearance = std::min(hit.clearance, before[i] / hit.depth);
      before[i] = away;
      if (away < nearest) {
        nearest = away;
        hit.thing = static_cast<int>(i);
      }
    }
    if (nearest < reached) return hit;
    hit.depth += nearest / length;
  }
  hit.thing = -1;
  return hit;
}

Vector3 direction_of(const CameraModel& model, const Pose& pose, double u, double v) {
  return pose.orientation * Vector3((u - model.cx) / model.fx, (v - model.cy) / model.fy, 1);
}

}  // namespace verlet_cable::view

#include "guide/wheel.h"

#include <cmath>

namespace verlet_cable {

namespace {

double angle_of(const Vector3& point) {
  return std::atan2(point.y(), point.x());
}

}  // namespace

Vector3 tangent_point(const Pose& wheel, const SimulatedGuide& guide, int side, const Vector3& neighbour, const Vector3& near) {
  const Pose inverse = wheel.inverse();
  const auto seen = [&](const Vector3& point) -> Vector3 { return inverse.position + inverse.orientation * point; };
  const Vector3 from = seen(neighbour);
  const double distance = std::hypot(from.x(), from.y());
  if (!(distance > guide.radius)) {
    const double angle = angle_of(seen(near));
    return {guide.radius * std::cos(angle), guide.radius * std::sin(angle), 0};
  }
  const double turn = std::acos(guide.radius / distance), forward = side == 0 ? 1 : -1;
  const double angle = angle_of(from) + guide.sense * forward * turn;
  return {guide.radius * std::cos(angle), guide.radius * std::sin(angle), 0};
}

double arc_on_wheel(const SimulatedGuide& guide, const Attachment& attachment) {
  double angle = guide.sense * (angle_of(attachment.tangent_points[1]) - angle_of(attachment.tangent_points[0]));
  while (angle < 0) angle += 2 * M_PI;
  return guide.radius * angle;
}

}  // namespace verlet_cable

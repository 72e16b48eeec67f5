#include "contact/point_contact.h"

#include <algorithm>

namespace verlet_cable {

SurfaceNear surface_near(const MovingObstacle& moving, const Vector3& point, double part, double h, double reach) {
  const Pose pose = between(moving.start, moving.end, part);
  const Vector3 local = pose.orientation.conjugate() * (point - pose.position);
  const double padding = moving.obstacle->padding;
  const SurfacePoint surface = closest_point(moving.obstacle->shape, local, reach + padding);
  SurfaceNear near;
  near.distance = surface.distance - padding;
  if (near.distance >= reach) return near;
  near.normal = pose.orientation * surface.normal;
  near.surface_velocity = surface_motion(moving, local).displacement / h;
  return near;
}

Vector3 bounced(const Vector3& velocity, const SurfaceNear& surface, double restitution, double friction) {
  const Vector3 relative = velocity - surface.surface_velocity;
  const double approach = -relative.dot(surface.normal);
  if (!(approach > 0)) return velocity;
  const Vector3 along = relative + approach * surface.normal;
  const double speed = along.norm(), lost = std::min(speed, friction * (1 + restitution) * approach);
  const double kept = speed > 0 ? 1 - lost / speed : 0;
  return surface.surface_velocity + kept * along + restitution * approach * surface.normal;
}

Vector3 press(const Vector3& velocity, NodeContact& contact) {
  const Vector3& n = contact.surface.normal;
  const Vector3 relative = velocity - contact.surface.surface_velocity;
  const double across = relative.dot(n);
  const double pushed = std::max(0.0, contact.pushed + contact.least_velocity - across);
  const Vector3 wanted = contact.rubbed - (relative - across * n);
  const double most = contact.friction * pushed, size = wanted.norm();
  const Vector3 rubbed = size > most ? Vector3(most / size * wanted) : wanted;
  const Vector3 change = (pushed - contact.pushed) * n + rubbed - contact.rubbed;
  contact.pushed = pushed;
  contact.rubbed = rubbed;
  return velocity + change;
}

}  // namespace verlet_cable

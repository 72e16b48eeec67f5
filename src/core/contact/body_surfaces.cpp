#include "contact/body_surfaces.h"

#include <algorithm>

#include "contact/cache.h"

namespace verlet_cable {

namespace {

Shape solid_of(const Shape& shape) {
  const auto* mesh = std::get_if<MeshShape>(&shape);
  return mesh == nullptr ? shape : Shape(mesh->solid());
}

Vector3 center_of(const SimulatedBody& body) {
  return body.pose.position + body.pose.orientation * body.center_of_mass;
}

}  // namespace

PointMotion velocity_of(const SimulatedBody& body) {
  return {center_of(body), body.velocity, body.angular_velocity};
}

PointMotion acceleration_of(const SimulatedBody& body, const BodyProgress& progress) {
  return {center_of(body), progress.acceleration, body.pose.orientation * progress.angular_acceleration};
}

void BodySurfaces::add(int index, const SimulatedBody& body, const BodyProgress& progress, double h) {
  for (std::size_t i = 0; i < body.shapes.size(); ++i) {
    const std::size_t place = moving_.size();
    if (obstacles_.size() <= place) obstacles_.emplace_back();
    Obstacle& obstacle = obstacles_[place];
    obstacle.shape = solid_of(body.shapes[i].shape);
    obstacle.friction = body.friction;
    obstacle.holders.assign(1, body.frame);
    obstacle.id = static_cast<std::uint32_t>(i);
    MovingObstacle& moving = moving_.emplace_back();
    moving.body = index;
    moving.index = -1;
    moving.start = moving.end = body.pose * body.shapes[i].pose;
    moving.box = bounds(obstacle.shape, moving.start);
    moving.body_velocity = velocity_of(body);
    moving.body_acceleration = acceleration_of(body, progress);
    const double size = largest_distance(moving.box, moving.body_velocity.center);
    moving.speed = body.velocity.norm() + size * body.angular_velocity.norm();
    moving.body_mass = body.mass + body.fluid.added_mass.mean();
    const Vector3 turn = 0.5 * h * body.angular_velocity;
    if (!turn.isZero(0)) moving.half_turn = Quaternion(1, 0.5 * turn.x(), 0.5 * turn.y(), 0.5 * turn.z()).normalized();
  }
}

const std::vector<MovingObstacle>& BodySurfaces::all() {
  for (std::size_t i = 0; i < moving_.size(); ++i) moving_[i].obstacle = &obstacles_[i];
  return moving_;
}

double mass_at(const SimulatedBody& body, const Vector3& point, const Vector3& direction) {
  const Vector3 arm = body.pose.orientation.conjugate() * (point - body.pose.position) - body.center_of_mass;
  const Vector3 along = body.pose.orientation.conjugate() * direction, turning = arm.cross(along);
  const double mass = body.mass + body.fluid.added_mass.dot(along.cwiseAbs2());
  return 1 / (1 / mass + turning.dot(body.inertia.llt().solve(turning)));
}

}  // namespace verlet_cable

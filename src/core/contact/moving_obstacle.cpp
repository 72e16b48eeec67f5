#include "contact/moving_obstacle.h"

namespace verlet_cable {

namespace {

Pose between(const Pose& a, const Pose& b, double part) {
  return {a.position + part * (b.position - a.position), a.orientation.slerp(part, b.orientation)};
}

double largest_distance(const Aabb& box, const Vector3& from) {
  return (box.max() - from).cwiseAbs().cwiseMax((box.min() - from).cwiseAbs()).norm();
}

}  // namespace

void move_obstacles(const std::vector<Obstacle>& obstacles, const std::vector<Pose>& before, const std::vector<Pose>& after,
                    double time_step, double from, double to, std::vector<MovingObstacle>& all) {
  all.clear();
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    const Obstacle& obstacle = obstacles[i];
    if (!obstacle.present) continue;
    const Pose &first = before[obstacle.frame], &last = after[obstacle.frame];
    MovingObstacle moving;
    moving.obstacle = &obstacle;
    moving.index = static_cast<int>(i);
    moving.start = between(first, last, from) * obstacle.pose;
    moving.end = between(first, last, to) * obstacle.pose;
    moving.box = bounds(obstacle.shape, moving.start);
    const double angle = first.orientation.angularDistance(last.orientation);
    double distance = (last.position - first.position).norm();
    if (angle > 0) distance += angle * largest_distance(moving.box, moving.start.position);
    moving.speed = distance / time_step;
    all.push_back(moving);
  }
}

}  // namespace verlet_cable

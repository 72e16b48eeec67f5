#include "contact/moving_obstacle.h"

#include <algorithm>

namespace verlet_cable {

namespace {

FrameVelocity mean_velocity(const Pose& from, const Pose& to, double time_step) {
  return {(to.position - from.position) / time_step, rotation_vector((to * from.inverse()).orientation) / time_step};
}

}  // namespace

SurfaceMotion surface_motion(const MovingObstacle& moving, const Vector3& point) {
  const Vector3 start = moving.start.position + moving.start.orientation * point;
  const Vector3 end = moving.end.position + moving.end.orientation * point;
  return {end - start, moving.end_velocity.linear + moving.end_velocity.angular.cross(end - moving.frame_end)};
}

SurfaceMotion touching_motion(const MovingObstacle& moving, const Vector3& point, const Vector3& normal, double h) {
  SurfaceMotion motion = surface_motion(moving, point);
  motion.end_velocity += normal.dot(motion.displacement / h - motion.end_velocity) * normal;
  return motion;
}

bool is_joined_to(const Obstacle& obstacle, int frame) {
  return std::binary_search(obstacle.holders.begin(), obstacle.holders.end(), frame);
}

double largest_distance(const Aabb& box, const Vector3& from) {
  return (box.max() - from).cwiseAbs().cwiseMax((box.min() - from).cwiseAbs()).norm();
}

void move_obstacles(const std::vector<Obstacle>& obstacles, const FramePoses& frames, double time_step, double from, double to,
                    std::vector<MovingObstacle>& all) {
  all.clear();
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    const Obstacle& obstacle = obstacles[i];
    if (!obstacle.present) continue;
    const Pose &first = frames.before[obstacle.frame], &last = frames.after[obstacle.frame];
    MovingObstacle moving;
    moving.obstacle = &obstacle;
    moving.index = static_cast<int>(i);
    moving.start = between(first, last, from) * obstacle.pose;
    moving.end = between(first, last, to) * obstacle.pose;
    moving.box = bounds(obstacle.shape, moving.start);
    moving.frame_end = between(first, last, to).position;
    const double angle = first.orientation.angularDistance(last.orientation);
    double distance = (last.position - first.position).norm();
    if (angle > 0) {
      distance += angle * largest_distance(moving.box, moving.start.position);
      moving.half_turn = Quaternion::Identity().slerp(0.5 * (to - from), (last * first.inverse()).orientation);
    }
    moving.speed = distance / time_step;
    if (moving.speed > 0 && to > from) {
      const FrameVelocity mean = mean_velocity(first, last, time_step);
      const FrameVelocity last_mean = mean_velocity(frames.earlier[obstacle.frame], first, time_step);
      moving.end_velocity.linear = mean.linear + (to - 0.5) * (mean.linear - last_mean.linear);
      moving.end_velocity.angular = mean.angular + (to - 0.5) * (mean.angular - last_mean.angular);
    }
    all.push_back(moving);
  }
}

}  // namespace verlet_cable

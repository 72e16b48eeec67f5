#pragma once

#include <vector>

#include "verlet_cable/core/obstacle.h"

namespace verlet_cable {

/// How the points of a rigid body move: first or second derivatives of their places.
struct PointMotion {
  Vector3 center = Vector3::Zero();  ///< [m] of mass
  Vector3 linear = Vector3::Zero(), angular = Vector3::Zero();

  Vector3 at(const Vector3& point) const { return linear + angular.cross(point - center); }
};

/// An obstacle during a substep.
struct MovingObstacle {
  const Obstacle* obstacle = nullptr;
  int index = 0;                                  ///< into World::obstacles()
  Pose start, end;                                ///< of its shape
  Aabb box;                                       ///< around it at the start, in the fixed frame [m]
  double speed = 0;                               ///< [m/s] no point of it is faster
  FrameVelocity end_velocity;                     ///< of its frame, seen from the fixed frame
  Vector3 frame_end = Vector3::Zero();            ///< [m] of its frame's origin
  Quaternion half_turn = Quaternion::Identity();  ///< of it in half the substep, seen from the fixed frame
  int body = -1;                  ///< whose shape it is, which moves as contacts let it; index into World::bodies()
  PointMotion body_velocity;      ///< [m/s], [rad/s]
  PointMotion body_acceleration;  ///< [m/s^2], [rad/s^2]
  double body_mass = 0;           ///< [kg]
};

/// What a point that is joined to an obstacle does in a substep, in the fixed frame.
struct SurfaceMotion {
  Vector3 displacement = Vector3::Zero();  ///< [m]
  Vector3 end_velocity = Vector3::Zero();  ///< [m/s]
};

/// `point` [m]: in the axes of the shape. The velocity at the end goes on from the mean velocities of this and the last step.
SurfaceMotion surface_motion(const MovingObstacle& moving, const Vector3& point);

/// The same where something touches, over a substep of h [s]: across the surface the velocity is the mean one, so that what
/// begins to move does not throw.
SurfaceMotion touching_motion(const MovingObstacle& moving, const Vector3& point, const Vector3& normal, double h);

/// Whether a frame is rigidly joined to an obstacle.
bool is_joined_to(const Obstacle& obstacle, int frame);

/// [m] From a point to the farthest one of a box.
double largest_distance(const Aabb& box, const Vector3& from);

/// Poses of frames, by their ids, a step apart.
struct FramePoses {
  const std::vector<Pose>&earlier, &before, &after;
};

/// The obstacles that are there, as they move over a part of a step, 0 to 1, between two poses of their frames.
void move_obstacles(const std::vector<Obstacle>& obstacles, const FramePoses& frames, double time_step, double from, double to,
                    std::vector<MovingObstacle>& moving);

}  // namespace verlet_cable

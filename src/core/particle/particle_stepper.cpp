#include "particle/particle_stepper.h"

#include <algorithm>

#include "contact/point_contact.h"
#include "net/step.h"

namespace verlet_cable {

namespace {

/// In one step; then a particle lies.
constexpr int most_bounces = 8;
constexpr int bisections = 40;
/// Of a flight: what is thinner than one of them may be missed.
constexpr int most_probes = 32;

class Gravity : public PointForces {
 public:
  explicit Gravity(const GravityDesc& gravity) : gravity_(gravity) {}
  void accelerate(double, const std::vector<Vector3>& positions, const std::vector<Vector3>&,
                  std::vector<Vector3>& accelerations) override {
    for (std::size_t i = 0; i < positions.size(); ++i) accelerations[i] = gravity_.at(positions[i]);
  }
  void hold(double, std::vector<Vector3>&, std::vector<Vector3>&) override {}

 private:
  const GravityDesc& gravity_;
};

struct Flight {
  Vector3 position, velocity;
};

/// Verlet's step of any length.
Flight fly(const GravityDesc& gravity, const Flight& from, double time) {
  const Vector3 before = gravity.at(from.position);
  const Vector3 position = from.position + time * (from.velocity + 0.5 * time * before);
  return {position, from.velocity + 0.5 * time * (before + gravity.at(position))};
}

struct Hit {
  const MovingObstacle* moving = nullptr;
  double time = 0;  ///< [s] since the start of the flight
};

/// A time within a flight from a part of the step at which it is inside an obstacle that it is not inside of at its start; below
/// 0 if there is none. Where the obstacle is far, the flight is followed in strides that do not reach it (conservative
/// advancement).
double time_inside(const SceneDesc& scene, const MovingObstacle& moving, const Flight& from, double part, double time) {
  const double h = scene.time_step;
  const auto near_at = [&](double t, double reach) {
    return surface_near(moving, fly(scene.gravity, from, t).position, part + t / h, h, reach).distance;
  };
  if (near_at(time, 0) < 0) return time;
  const double speed = std::max(from.velocity.norm(), fly(scene.gravity, from, time).velocity.norm()) + moving.speed;
  for (double t = 0; t < time;) {
    const double left = speed * (time - t), distance = near_at(t, left);
    if (distance >= left) return -1;
    if (distance < 0) return t > 0 ? t : -1;
    t += std::max(distance / speed, time / most_probes);
  }
  return -1;
}

/// The first obstacle that a flight of `time` [s] from a part of the step meets.
Hit first_hit(const SceneDesc& scene, const std::vector<MovingObstacle>& obstacles, const Flight& from, double part,
              double time) {
  const double h = scene.time_step;
  Hit hit;
  for (const MovingObstacle& moving : obstacles) {
    const auto is_inside = [&](double t) {
      return surface_near(moving, fly(scene.gravity, from, t).position, part + t / h, h, 0).distance < 0;
    };
    double outside = 0, inside = time_inside(scene, moving, from, part, hit.moving ? hit.time : time);
    if (inside < 0) continue;
    for (int i = 0; i < bisections; ++i) {
      const double middle = 0.5 * (outside + inside);
      (is_inside(middle) ? inside : outside) = middle;
    }
    hit = {&moving, outside};
  }
  return hit;
}

/// The step anew, from bounce to bounce.
Flight bounce_along(const SceneDesc& scene, const std::vector<MovingObstacle>& obstacles, const ParticleDesc& desc,
                    Flight flight) {
  const double h = scene.time_step;
  double left = h;
  for (int i = 0; i < most_bounces; ++i) {
    const double part = 1 - left / h;
    const Hit hit = first_hit(scene, obstacles, flight, part, left);
    if (!hit.moving) return fly(scene.gravity, flight, left);
    flight = fly(scene.gravity, flight, hit.time);
    left -= hit.time;
    const SurfaceNear surface = surface_near(*hit.moving, flight.position, 1 - left / h, h, infinity);
    if (surface.distance < 0) flight.position -= surface.distance * surface.normal;
    const double friction = hit.moving->obstacle->friction.value_or(desc.friction);
    flight.velocity = bounced(flight.velocity, surface, desc.restitution, friction);
  }
  // It lies, and what it lies on carries it for the rest of the step.
  for (const MovingObstacle& moving : obstacles) {
    const SurfaceNear surface = surface_near(moving, flight.position, 1, h, 0);
    if (surface.distance < 0) flight.position -= surface.distance * surface.normal;
  }
  return flight;
}

}  // namespace

bool ParticleStepper::advance(const SceneDesc& scene, const std::vector<MovingObstacle>& obstacles, SimulatedParticle& particle,
                              PointState& memory) {
  memory.positions[0] = particle.position;
  memory.velocities[0] = particle.velocity;
  Gravity gravity(scene.gravity);
  integrator_.advance(scene.integrator, scene.time_step, gravity, memory);
  for (const MovingObstacle& moving : obstacles) {
    if (time_inside(scene, moving, {particle.position, particle.velocity}, 0, scene.time_step) < 0 &&
        !(surface_near(moving, memory.positions[0], 1, scene.time_step, 0).distance < 0))
      continue;
    const Flight flight = bounce_along(scene, obstacles, particle.desc, {particle.position, particle.velocity});
    memory.positions[0] = flight.position;
    memory.velocities[0] = flight.velocity;
    memory.restart();
    break;
  }
  if (!is_sane(memory.positions) || !is_sane(memory.velocities)) return false;
  particle.position = memory.positions[0];
  particle.velocity = memory.velocities[0];
  return true;
}

}  // namespace verlet_cable

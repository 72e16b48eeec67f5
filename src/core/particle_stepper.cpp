#include "particle_stepper.h"

#include "net_step.h"
#include "point_contact.h"

namespace verlet_cable {

namespace {

/// In one step; then a particle lies.
constexpr int most_bounces = 8;
constexpr int bisections = 40;

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

/// The first obstacle that a flight of `time` [s] from a part of the step ends in.
Hit first_hit(const SceneDesc& scene, const std::vector<MovingObstacle>& obstacles, const Flight& from, double part,
              double time) {
  const double h = scene.time_step;
  Hit hit;
  for (const MovingObstacle& moving : obstacles) {
    const auto is_inside = [&](double t) {
      return surface_near(moving, fly(scene.gravity, from, t).position, part + t / h, h, 0).distance < 0;
    };
    const double latest = hit.moving ? hit.time : time;
    if (!is_inside(latest)) continue;
    double outside = 0, inside = latest;
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
    if (!(surface_near(moving, memory.positions[0], 1, scene.time_step, 0).distance < 0)) continue;
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

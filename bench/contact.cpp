#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "contact_scenes.h"
#include "rows.h"
#include "stopwatch.h"

namespace verlet_cable::bench {

namespace {

constexpr double pi = 3.14159265358979323846;

/// Distance of two segments' centre lines [m], by golden sections: apart from the package's own way to find it.
double distance(const Vector3& a0, const Vector3& a1, const Vector3& b0, const Vector3& b1) {
  const Vector3 along = b1 - b0;
  const auto from = [&](double s) {
    const Vector3 point = a0 + s * (a1 - a0);
    const double t = std::clamp((point - b0).dot(along) / along.squaredNorm(), 0.0, 1.0);
    return (point - b0 - t * along).norm();
  };
  const double section = 0.5 * (std::sqrt(5.0) - 1);
  double low = 0, high = 1;
  for (int i = 0; i < 25; ++i) {
    const double first = high - section * (high - low), second = low + section * (high - low);
    (from(first) < from(second) ? high : low) = from(first) < from(second) ? second : first;
  }
  return std::min({from(low), from(0), from(1)});
}

/// Closest approach of a cable's segments to each other, those left out that a bend of the radius joins [m].
double closest_approach(const SimulatedCable& cable) {
  const std::vector<Vector3>& x = cable.state.positions;
  double closest = infinity;
  for (int i = 0; i < cable.state.segments(); ++i)
    for (int j = i + 2; j < cable.state.segments(); ++j) {
      const double reach = cable.state.rest_lengths[i] + 2 * contact_radius;
      if (cable.state.length(i + 1, j) < 2.5 * contact_radius || (x[i] - x[j]).squaredNorm() > 4 * reach * reach) continue;
      closest = std::min(closest, distance(x[i], x[i + 1], x[j], x[j + 1]));
    }
  return closest;
}

/// How deep a cable is in an obstacle, at any point [m].
double depth(const SimulatedCable& cable, const Obstacle& obstacle) {
  const Pose to_shape = obstacle.pose.inverse();
  const std::vector<Vector3>& x = cable.state.positions;
  const auto local = [&](const Vector3& point) { return Vector3(to_shape.position + to_shape.orientation * point); };
  double deepest = -infinity;
  for (std::size_t i = 0; i + 1 < x.size(); ++i)
    deepest = std::max(deepest, contact_radius - deepest_point(obstacle.shape, local(x[i]), local(x[i + 1])).surface.distance);
  return deepest;
}

double fastest(const World& world) {
  double speed = 0;
  for (const SimulatedCable& cable : world.cables())
    for (const Vector3& v : cable.state.velocities) speed = std::max(speed, v.norm());
  return speed;
}

void capstans(Report& report, bool quick) {
  report.table(
      "Light cable drawn over a cylinder, n = 100: ratio of the forces at its ends while it slips, against exp(friction * angle)",
      {"friction", "angle [deg]", "ratio", "Euler", "error", "target", "verdict", "real time", "target", "verdict"});
  for (const double degrees : quick ? std::vector<double>{180, 540} : std::vector<double>{90, 180, 360, 540})
    for (const double friction : {0.1, 0.3, 0.5}) {
      const double angle = degrees * pi / 180, speed = 0.1, duration = 1.0, time_step = 0.001;
      const SceneDesc scene = capstan(friction, angle, 100);
      BoundaryInputs frames = initial_frames(scene);
      World world(scene, frames);
      const int steps = static_cast<int>(duration / time_step);
      double first = 0, second = 0;
      const double start = processor_seconds();
      for (int i = 1; i <= steps; ++i) {
        frames[1].pose.position -= speed * time_step * capstan_first_pull();
        frames[2].pose.position += speed * time_step * capstan_second_pull(angle);
        world.step(frames);
        if (i <= steps / 2) continue;
        first += world.attachments()[0].force.norm();
        second += world.attachments()[1].force.norm();
      }
      const double factor = duration / (processor_seconds() - start), expected = std::exp(friction * angle);
      const double error = std::abs(second / first / expected - 1);
      report.row({figure(friction), figure(degrees), figure(second / first, 4), figure(expected, 4), figure(error, 2),
                  figure(0.03), report.at_most(error, 0.03), figure(factor), figure(30), report.at_least(factor, 30)});
    }
}

void drops(Report& report, bool quick) {
  const int count = quick ? 10 : 200;
  report.table(
      "Drops of a cable of 1 m on an obstacle and a floor, " + std::to_string(count) +
          " of each type, 5 s: deepest point, speed at the end, energy",
      {"obstacle", "deepest / radius", "target", "verdict", "fastest [m/s]", "target", "verdict", "energy rise", "real time"});
  for (const auto& [name, type] : std::vector<std::pair<std::string, ShapeType>>{{"plane", ShapeType::plane},
                                                                                 {"sphere", ShapeType::sphere},
                                                                                 {"capsule", ShapeType::capsule},
                                                                                 {"cylinder", ShapeType::cylinder},
                                                                                 {"box", ShapeType::box},
                                                                                 {"mesh", ShapeType::mesh}}) {
    double deepest = 0, speed = 0, rise = 0, seconds = 0;
    for (int number = 0; number < count; ++number) {
      const SceneDesc scene = drop(type, number);
      const BoundaryInputs frames = initial_frames(scene);
      World world(scene, frames);
      const double energy = world.energy().total();
      for (int i = 1; i <= 5000; ++i) {
        const double start = processor_seconds();
        world.step(frames);
        seconds += processor_seconds() - start;
        rise = std::max(rise, world.energy().total() / energy - 1);
        if (i % 10 != 0) continue;
        for (const Obstacle& obstacle : world.obstacles()) deepest = std::max(deepest, depth(world.cables()[0], obstacle));
      }
      speed = std::max(speed, std::isfinite(world.energy().total()) ? fastest(world) : infinity);
    }
    report.row({name, figure(deepest / contact_radius), figure(0.2), report.at_most(deepest / contact_radius, 0.2),
                figure(speed, 2), figure(0.01), report.at_most(speed, 0.01), figure(rise, 2), figure(5 * count / seconds)});
  }
}

void knots(Report& report, bool quick) {
  report.table(
      "Overhand knot, n = 200, tightened by both hands: closest approach of centre lines",
      {"friction", "speed [m/s]", "closest / radius", "target", "verdict", "at the end", "target", "verdict", "real time"});
  for (const double friction : {0.1, 0.5})
    for (const double speed : quick ? std::vector<double>{2} : std::vector<double>{0.2, 2}) {
      const SceneDesc scene = overhand_knot(friction, 200);
      BoundaryInputs frames = initial_frames(scene);
      World world(scene, frames);
      const Vector3 apart = (frames[2].pose.position - frames[1].pose.position).normalized();
      const double travel = 0.44, time_step = 0.001;
      double closest = infinity, seconds = 0;
      const int steps = static_cast<int>((2 * travel / speed + 0.5) / time_step);
      for (int i = 1; i <= steps; ++i) {
        const double pulled = std::min(travel, 0.5 * speed * i * time_step);
        BoundaryInputs now = frames;
        now[1].pose.position -= pulled * apart;
        now[2].pose.position += pulled * apart;
        const double start = processor_seconds();
        world.step(now);
        seconds += processor_seconds() - start;
        closest = std::min(closest, closest_approach(world.cables()[0]));
      }
      // It holds: the strands still press on each other.
      const double held = closest_approach(world.cables()[0]) / contact_radius;
      report.row({figure(friction), figure(speed), figure(closest / contact_radius), figure(1.8),
                  report.at_least(closest / contact_radius, 1.8), figure(held), figure(2), report.at_most(held, 2),
                  figure(steps * time_step / seconds)});
    }
}

double real_time_factor(const SceneDesc& scene, double duration) {
  const BoundaryInputs frames = initial_frames(scene);
  World world(scene, frames);
  const int steps = static_cast<int>(duration / scene.time_step);
  const double start = processor_seconds();
  for (int i = 0; i < steps; ++i) world.step(frames);
  return duration / (processor_seconds() - start);
}

void crowds(Report& report, bool quick) {
  report.table("Many contacts: times real time, one thread", {"scene", "real time", "target", "verdict"});
  const double duration = quick ? 1 : 3;
  const double loose = real_time_factor(coils(200, false), duration), self = real_time_factor(coils(200, true), duration);
  report.row({"cost of self-contact, 200 segments", figure(loose / self), "<= 3", report.at_most(loose / self, 3)});
  const double pile = real_time_factor(coils(1000, true), duration);
  report.row({"self-contact, 200 segments", figure(self), "3", report.at_least(self, 3)});
  report.row({"pile of 1000 segments", figure(pile), "2", report.at_least(pile, 2)});
  const double crowd = real_time_factor(crosswise(20, 100), duration);
  report.row({"20 cables of 100 segments, crosswise", figure(crowd), "2", report.at_least(crowd, 2)});
}

}  // namespace

void contact(Report& report, bool quick) {
  capstans(report, quick);
  knots(report, quick);
  crowds(report, quick);
  drops(report, quick);
}

}  // namespace verlet_cable::bench

#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "rollouts.h"
#include "rows.h"
#include "scenes.h"
#include "stopwatch.h"

namespace verlet_cable::bench {

namespace {

constexpr int segments = 50;
constexpr double spacing = 2;  // [m] between cables that are apart; they are 1 m long

double allocated() {
  return static_cast<double>(mallinfo2().uordblks);
}

/// Cables that hang between two points, side by side on a square, and swing a little.
SceneDesc many_cables(int count, bool contact) {
  SceneDesc scene = scenes::between_two_points(segments, 0.6);
  const CableDesc first = scene.cables[0];
  scene.cables.assign(count, first);
  scene.limits.segments = count * segments;
  const int columns = static_cast<int>(std::ceil(std::sqrt(count)));
  for (int i = 0; i < count; ++i) {
    CableDesc& cable = scene.cables[i];
    cable.name = "cable_" + std::to_string(i);
    for (AttachmentDesc& attachment : cable.attachments) {
      attachment.name += "_" + std::to_string(i);
      attachment.offset += Vector3(spacing * (i % columns), spacing * (i / columns), 0);
    }
  }
  if (contact) scene.contact = ContactDesc{};
  return scene;
}

struct Cost {
  double construction = 0;  ///< [s]
  double bytes = 0;         ///< a cable
  double copy = 0;          ///< [s] a cable
  double step = 0;          ///< [s] a cable and step, on one core
  double speedup = 0;       ///< on all cores
};

/// The least of some runs, each long enough for the clock.
template <class Work>
double seconds(const Work& work) {
  double least = 1e300;
  for (int run = 0; run < 5; ++run) {
    int times = 0;
    const double start = seconds_now();
    do {
      work();
      ++times;
    } while (seconds_now() - start < 0.1);
    least = std::min(least, (seconds_now() - start) / times);
  }
  return least;
}

Cost measure(int count, bool contact) {
  const SceneDesc scene = many_cables(count, contact);
  const BoundaryInputs inputs = initial_frames(scene);
  Cost cost;
  const double bytes = allocated(), start = seconds_now();
  World world(scene, inputs);
  cost.construction = seconds_now() - start;
  world.step_one_by_one(true);
  // Blown at from the side, so that they are not at rest.
  SceneDesc windy = scene;
  windy.fluid.velocity = {0.3, 1, 0};
  windy.materials[0].material.drag = 0.02;
  world.tune(windy);
  for (int i = 0; i < 20; ++i) world.step(inputs);
  cost.bytes = (allocated() - bytes) / count;
  cost.copy = seconds([&] { World copy(world); }) / count;
  cost.step = seconds([&] { world.step(inputs); }) / count;
  world.step_one_by_one(false);
  cost.speedup = cost.step / (seconds([&] { world.step(inputs); }) / count);
  return cost;
}

/// Real-time factor of all cables of a world on all cores.
double real_time_factor(SceneDesc scene) {
  scene.time_step = 0.01;
  const BoundaryInputs inputs = initial_frames(scene);
  World world(scene, inputs);
  SceneDesc windy = scene;
  windy.fluid.velocity = {0.3, 1, 0};
  windy.materials[0].material.drag = 0.02;
  world.tune(windy);
  for (int i = 0; i < 20; ++i) world.step(inputs);
  return scene.time_step / seconds([&] { world.step(inputs); });
}

void in_real_time(Report& report, bool quick) {
  report.table("Many cables in real time, on all cores", {"", "real-time factor", "target", "verdict"});
  const int cables = quick ? 1000 : 10000;
  for (const double bending_stiffness : {0.0, 0.001}) {
    SceneDesc scene = many_cables(cables, false);
    scene.materials[0].material.bending_stiffness = bending_stiffness;
    const double factor = real_time_factor(scene) * cables / 10000;
    report.row({"10000 cables of 50 segments in the wind, 10 ms, EI = " + figure(bending_stiffness) + " N m^2", figure(factor),
                "1", report.at_least(factor, 1)});
  }
  const int rollouts = quick ? 200 : 1000;
  for (const bool bends : {false, true}) {
    const double factor = rollouts / 1000.0 / run({rollouts, 100, bends, true}).seconds;
    report.row({std::string("1000 rollouts of 100 segments, driven, 5 ms, ") + (bends ? "clamped, EI = 0.01 N m^2" : "hinged"),
                figure(factor), "2.5", report.at_least(factor, 2.5)});
  }
  const double apart = (rollouts / 10) / 1000.0 / run({rollouts / 10, 100, false, false}).seconds;
  report.note("hinged, world after world on one core: " + figure(apart));
}

}  // namespace

void many(Report& report, bool quick) {
  in_real_time(report, quick);
  for (const bool contact : {false, true}) {
    report.table(std::string("Many cables of 50 segments that hang side by side") +
                     (contact ? ", looking out for each other (contact: {})" : ", apart"),
                 {"cables", "step [us/cable]", "construction [s]", "target", "verdict", "memory [kB/cable]", "target", "verdict",
                  "copy [us/cable]", "target", "verdict", "all cores"});
    double cheapest = 1e300, dearest = 0;
    for (const int count : quick ? std::vector<int>{10, 100, 1000} : std::vector<int>{10, 100, 1000, 10000}) {
      const Cost cost = measure(count, contact);
      cheapest = std::min(cheapest, cost.step);
      dearest = std::max(dearest, cost.step);
      report.row({std::to_string(count), figure(1e6 * cost.step), figure(cost.construction), "1",
                  report.at_most(cost.construction, 1), figure(1e-3 * cost.bytes), "15", report.at_most(1e-3 * cost.bytes, 15),
                  figure(1e6 * cost.copy), "5", report.at_most(1e6 * cost.copy, 5), figure(cost.speedup)});
    }
    const std::string flatness = figure(dearest / cheapest);
    report.note("dearest cable over cheapest: " + flatness +
                (contact ? "" : " (target 1.2, " + report.at_most(dearest / cheapest, 1.2) + ")"));
  }
}

}  // namespace verlet_cable::bench

#include <algorithm>
#include <cmath>

#include "analytic_beam.h"
#include "rows.h"
#include "scenes.h"
#include "stopwatch.h"

namespace verlet_cable::bench {

namespace {

constexpr int segments = 50;
constexpr double bending_stiffness = 0.1;                         // [N m^2]
constexpr double largest_error = 2e-4, largest_milliseconds = 5;  // to reach
constexpr double weightless = 1e-9;                               // [kg/m]
constexpr double gravity = 9.81;

/// Horizontal, clamped at its start, of length 1 m; a weight at its tip bends it.
SceneDesc loaded_cantilever(double load) {
  SceneDesc scene = scenes::one_cable(segments);
  scene.materials[0].material.linear_density = weightless;
  scene.materials[0].material.bending_stiffness = bending_stiffness;
  CableDesc& cable = scene.cables[0];
  cable.attachments = {scenes::attachment("root", PlaceDesc::At::start, {0, 0, 0}, "", AttachmentType::clamp)};
  cable.initial.type = InitialShapeDesc::Type::straight;
  cable.point_masses = {scenes::payload(load * bending_stiffness / gravity)};
  return scene;
}

}  // namespace

void cantilever(Report& report, bool quick) {
  report.table(
      "Cantilever from straight into equilibrium under a load P at its tip, n = 50, EI = 0.1 N m^2, against the elastica",
      {"P L^2/EI", "deflection / L", "elastica", "error", "target", "verdict", "settled in [ms]", "target", "verdict"});
  for (const double load : {1.0, 2.0, 5.0, 10.0}) {
    const SceneDesc scene = loaded_cantilever(load);
    const World straight(scene, initial_frames(scene));
    double seconds = 1e300, deflection = 0;
    bool settled = true;
    for (int i = 0; i < (quick ? 5 : 20); ++i) {
      World world = straight;
      const double start = processor_seconds();
      settled = world.settle() && settled;
      seconds = std::min(seconds, processor_seconds() - start);
      deflection = -world.cables()[0].state.positions[segments].z();
    }
    const double expected = std::abs(analytic::elastica(load, segments).back().y());
    const double error = settled ? std::abs(deflection / expected - 1) : 1;
    report.row({figure(load), figure(deflection, 6), figure(expected, 6), figure(error, 2), figure(largest_error),
                report.at_most(error, largest_error), figure(1e3 * seconds), figure(largest_milliseconds),
                report.at_most(settled ? 1e3 * seconds : 1e300, largest_milliseconds)});
  }
}

}  // namespace verlet_cable::bench

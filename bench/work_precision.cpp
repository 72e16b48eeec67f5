#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "hand.h"
#include "rows.h"
#include "scenes.h"
#include "stopwatch.h"

namespace verlet_cable::bench {

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double duration = 10, sample_interval = 0.02;  // [s]
constexpr double tolerance = 1e-3;                       // [m]
constexpr int segments = 100;
/// Steps are the sample interval in so many parts: 10 to 1 ms.
constexpr int coarsest = 2, finest = 20, converged = 160;

struct Case {
  std::string name;
  SceneDesc scene;
  int node = 0;         ///< the one compared
  bool driven = false;  ///< by the frame "hand"
  double target = 0;    ///< real-time factor
};

struct Run {
  std::vector<Vector3> samples;
  double cost = 0;  ///< processor time a simulated second [s]
};

Run run(const Case& c, int parts) {
  SceneDesc scene = c.scene;
  scene.time_step = sample_interval / parts;
  BoundaryInputs inputs = c.driven ? scenes::hand_at(driven_hand(0)) : initial_frames(scene);
  World world(scene, inputs);
  // Else every mode of the undamped cable rings, also those that no step of 1 ms or more can follow.
  if (c.driven && !world.settle()) throw std::runtime_error(c.name + ": no equilibrium to start from");
  Run result;
  const double start = processor_seconds();
  for (int k = 0; k < std::lround(duration / sample_interval); ++k) {
    for (int i = 0; i < parts; ++i) {
      if (c.driven) inputs[1].pose.position = driven_hand(world.time() + scene.time_step);
      world.step(inputs);
    }
    result.samples.push_back(world.cables()[0].state.positions[c.node]);
  }
  result.cost = (processor_seconds() - start) / duration;
  return result;
}

double largest_distance(const Run& a, const Run& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.samples.size(); ++i) largest = std::max(largest, (a.samples[i] - b.samples[i]).norm());
  return largest;
}

void precision_row(Report& report, const Case& c, int repetitions) {
  const Run reference = run(c, converged);
  const double reference_error = largest_distance(run(c, converged / 2), reference);
  struct Accepted {
    int parts;
    double error, cost;
  };
  std::optional<Accepted> best;
  double smallest_error = 1e300;
  for (int parts = coarsest; parts <= finest; ++parts) {
    const Run candidate = run(c, parts);
    const double error = largest_distance(candidate, reference);
    smallest_error = std::min(smallest_error, error);
    if (error > tolerance || (best && candidate.cost > 1.5 * best->cost)) continue;
    double cost = candidate.cost;
    for (int i = 0; i < repetitions; ++i) cost = std::min(cost, run(c, parts).cost);
    if (!best || cost < best->cost) best = Accepted{parts, error, cost};
  }
  const std::string uncertainty = figure(1e3 * reference_error, 2);
  if (best)
    report.row({c.name, figure(1e3 * sample_interval / best->parts), figure(1e3 * best->error, 2), uncertainty,
                figure(1 / best->cost), figure(c.target), report.at_least(1 / best->cost, c.target)});
  else
    report.row(
        {c.name, "none", figure(1e3 * smallest_error, 2), uncertainty, "-", figure(c.target), report.at_least(0, c.target)});
}

Case clamped(double bending_stiffness) {
  Case c;
  c.name = "clamped, driven, EI = " + figure(bending_stiffness) + " N m^2";
  c.scene = scenes::held_by_a_hand(segments, AttachmentType::clamp);
  c.scene.materials[0].material.bending_stiffness = bending_stiffness;
  c.node = segments / 2;
  c.driven = true;
  c.target = 250;
  return c;
}

}  // namespace

void work_precision(Report& report, bool quick) {
  report.table(
      "Work against precision, n = 100, 10 s: the fastest step of 1 to 10 ms within 1 mm of a run at 0.125 ms",
      {"                               case", "step [ms]", "error [mm]", "of the reference [mm]", "   RTF", "target", "verdict"});
  const int repetitions = quick ? 1 : 3;
  Case free;
  free.name = "inextensible, released at 20 degrees";
  free.scene = scenes::released(segments, pi / 9);
  free.node = segments;
  free.target = 500;
  precision_row(report, free, repetitions);
  for (const double bending_stiffness : {1e-3, 1e-2, 1.0}) precision_row(report, clamped(bending_stiffness), repetitions);
}

}  // namespace verlet_cable::bench

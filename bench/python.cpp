#include <algorithm>
#include <array>
#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "rollouts.h"
#include "rows.h"
#include "scenes.h"
#include "stopwatch.h"

namespace verlet_cable::bench {
namespace {

constexpr int segments = 50;
constexpr int worlds = 1024;
constexpr int steps = 200;

/// The least of some turns [s].
struct Cost {
  double importing = 1e300, step = 1e300, rollouts = 1e300;
  std::uint64_t hash = 0;

  void add(const Cost& turn) {
    importing = std::min(importing, turn.importing);
    step = std::min(step, turn.step);
    rollouts = std::min(rollouts, turn.rollouts);
    hash = turn.hash;
  }
};

double time_a_step() {
  const World start = start_of({1, segments});
  double least = 1e300;
  for (int run = 0; run < 50; ++run) {
    World world = start;
    const BoundaryInputs inputs = scenes::hand_at(world.frame_pose(1).position);
    const double begin = seconds_now();
    for (int i = 0; i < steps; ++i) world.step(inputs);
    least = std::min(least, (seconds_now() - begin) / steps);
  }
  return least;
}

Cost of_cpp() {
  const RolloutResult result = run({worlds, segments});
  return {0, time_a_step(), result.seconds, result.hash};
}

/// Of a process of its own.
Cost of_python() {
  const std::string command = std::string("PYTHONPATH='" VERLET_CABLE_PYTHON_PATH "' '" VERLET_CABLE_PYTHON "' '" BENCH_DIRECTORY
                                          "/python_rollouts.py' ") +
                              std::to_string(worlds) + " " + std::to_string(segments) + " " + std::to_string(steps);
  std::FILE* output = popen(command.c_str(), "r");
  if (!output) throw std::runtime_error("cannot run " + command);
  Cost cost;
  const int read = std::fscanf(output, "%lf %lf %lf %" SCNx64, &cost.importing, &cost.step, &cost.rollouts, &cost.hash);
  if (pclose(output) != 0 || read != 4) throw std::runtime_error("it failed: " + command);
  return cost;
}

}  // namespace

void python(Report& report, bool quick) {
  Cost cpp, python;
  for (int turn = 0; turn < (quick ? 3 : 9); ++turn) {
    cpp.add(of_cpp());
    python.add(of_python());
  }
  report.table("Python beside C++: a cable of 50 segments, 5 ms, held by a hand",
               {"", "C++", "Python", "dearer by", "target", "verdict"});
  const double call = python.step - cpp.step;
  report.row({"World.step(1) at rest [us]", figure(1e6 * cpp.step), figure(1e6 * python.step), figure(1e6 * call) + " us", "5 us",
              report.at_most(1e6 * call, 5)});
  const double ratio = python.rollouts / cpp.rollouts;
  report.row({"1024 rollouts of 200 steps, all cores [s]", figure(cpp.rollouts), figure(python.rollouts),
              figure(100 * (ratio - 1)) + " %", "15 %", report.at_most(ratio, 1.15)});
  report.row({"import verlet_cable.sim after numpy [s]", "", figure(python.importing), "", "0.05",
              report.at_most(python.importing, 0.05)});
  report.note(python.hash == cpp.hash ? "both end with the same bytes" : "MISMATCH: they do not end with the same bytes");
}

}  // namespace verlet_cable::bench

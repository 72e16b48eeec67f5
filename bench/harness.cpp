#include "harness.h"

#include <algorithm>
#include <cmath>

#include "rows.h"
#include "stopwatch.h"

namespace verlet_cable::bench {

namespace {

constexpr double pi = 3.14159265358979323846;

/// Settled, then both hands go to and fro, up and down, and turn.
class MovingHarness {
 public:
  MovingHarness(int branches, int segments, const BendingStiffness& stiffness) {
    SceneDesc scene = scenes::harness(branches, segments, stiffness);
    for (CableDesc& cable : scene.cables) cable.initial.type = InitialShapeDesc::Type::settled;
    start_ = initial_frames(scene);
    inputs_ = start_;
    world_ = std::make_unique<World>(scene, inputs_);
  }
  /// Processor time [s] of a simulated second.
  double run(int steps) {
    const double start = processor_seconds();
    for (int i = 0; i < steps; ++i) {
      const double t = world_->time() + world_->time_step();
      for (const int hand : {1, 2}) {
        const double side = hand == 1 ? 1 : -1;
        inputs_[hand].pose.position =
            start_[hand].pose.position +
            Vector3(0.05 * side * (1 - std::cos(2 * pi * t)), 0.1 * std::sin(2 * pi * t), 0.05 * std::sin(3 * pi * t));
        inputs_[hand].pose.orientation = Eigen::AngleAxisd(0.5 * std::sin(2 * pi * t), Vector3::UnitX());
      }
      const StepResult result = world_->step(inputs_);
      iterations += result.iterations;
      unsound += result.status != StepResult::Status::ok;
    }
    return (processor_seconds() - start) / (steps * world_->time_step());
  }

  long iterations = 0;
  long unsound = 0;  ///< steps

 private:
  BoundaryInputs start_, inputs_;
  std::unique_ptr<World> world_;
};

}  // namespace

void harness(Report& report, bool quick) {
  constexpr int segments = 30;
  const int steps = quick ? 200 : 1000;
  report.table("A moving wire harness: a trunk of 30 segments between two hands, and branches of 30 with a plug each, 1 ms",
               {"branches", "     wires", "iterations a cable", "us a step", "   RTF", "target", "verdict"});
  for (const int branches : {1, 7, 14})
    for (const bool flat : {false, true}) {
      MovingHarness moving(branches, segments, flat ? BendingStiffness{0.002, 0.001} : BendingStiffness{0.002, 0.002});
      moving.run(200);
      moving.iterations = 0;
      double least = 1e300;
      constexpr int repetitions = 5;
      for (int i = 0; i < repetitions; ++i) least = std::min(least, moving.run(steps));
      const double iterations = static_cast<double>(moving.iterations) / (repetitions * steps) / (branches + 1);
      const double target = 20.0 * 7 / branches;
      report.row({std::to_string(branches), flat ? "flat" : "round", figure(iterations), figure(1e3 * least), figure(1 / least),
                  figure(target), moving.unsound > 0 ? "UNSOUND" : report.at_least(1 / least, target)});
    }
}

}  // namespace verlet_cable::bench

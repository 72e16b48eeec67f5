#pragma once

#include <functional>
#include <string>
#include <vector>

#include "verlet_cable/core/world.h"

/// What the validation cases share: a run, and the record of relative errors over a refinement.
namespace verlet_cable::validation {

/// A world of one cable and the poses of its frames.
struct Simulation {
  World world;
  BoundaryInputs inputs;

  explicit Simulation(const SceneDesc& scene) : Simulation(scene, initial_frames(scene)) {}
  Simulation(const SceneDesc& scene, const BoundaryInputs& frames) : world(scene, frames), inputs(frames) {}
  const SimulatedCable& cable() const { return world.cables()[0]; }
  const std::vector<Vector3>& positions() const { return cable().state.positions; }
  /// Steps; a status other than ok is a failure of the test.
  void step();
  void run(double duration);
  /// [N], [N m]: what the cable exerts on the holder.
  const Vector3& force(const std::string& attachment) const;
  const Vector3& torque(const std::string& attachment) const;
};

/// Three digits.
std::string short_text(double value);

/// A relative error at a refinement: number of segments, or of steps.
struct Sample {
  double n = 0;
  double error = 0;
};

enum class Order {
  none,   ///< the error does not depend on the refinement, or not smoothly
  second  ///< asserted: it falls with the square of the refinement
};

/// Prints and records the errors and their order (from the last two samples), and asserts that the error of the last sample is
/// within `tolerance`. In the directory named by the environment variable VALIDATION_OUTPUT, if it is set, a row a sample is
/// appended to errors.csv.
void report(const std::string& name, const std::vector<Sample>& samples, double tolerance, Order order);

/// Appends a curve to curves.csv in the same directory: case, label, x, y.
void record_curve(const std::string& name, const std::string& label, const std::vector<double>& x, const std::vector<double>& y);

/// Relative errors of `error(n)` for each n.
std::vector<Sample> sample(const std::vector<int>& segments, const std::function<double(int)>& error);

/// [rad/s] from the zero crossings of `amplitude` over `half_periods`, the run starting at its largest.
double angular_frequency(Simulation& run, const std::function<double(const Simulation&)>& amplitude, int half_periods);

}  // namespace verlet_cable::validation

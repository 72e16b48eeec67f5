#include <algorithm>
#include <cmath>

#include "rows.h"
#include "scenes.h"
#include "stopwatch.h"

namespace verlet_cable::bench {

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double segment_length = 0.01;  // [m]
constexpr double span = 0.6;             // of the length

/// The floor: a scalar tridiagonal system, solved by Thomas's algorithm, its matrix kept.
class ThomasSolve {
 public:
  explicit ThomasSolve(int rows)
      : lower_(rows, -1.0), diagonal_(rows, 2.1), upper_(rows, -1.0), load_(rows, 1.0), ratio_(rows), x_(rows) {}
  void run() {
    const std::size_t n = x_.size();
    double inverse = 1 / diagonal_[0];
    ratio_[0] = upper_[0] * inverse;
    x_[0] = load_[0] * inverse;
    for (std::size_t i = 1; i < n; ++i) {
      inverse = 1 / (diagonal_[i] - lower_[i] * ratio_[i - 1]);
      ratio_[i] = upper_[i] * inverse;
      x_[i] = (load_[i] - lower_[i] * x_[i - 1]) * inverse;
    }
    for (std::size_t i = n - 1; i-- > 0;) x_[i] -= ratio_[i] * x_[i + 1];
    // The next solve depends on this one: none can be left out.
    load_[0] = 1 + 1e-9 * x_[0];
  }
  double result() const { return x_[0]; }

 private:
  std::vector<double> lower_, diagonal_, upper_, load_, ratio_, x_;
};

/// What a cable resists.
struct Resistance {
  const char* name;
  AttachmentType attachment;
  BendingStiffness bending_stiffness;
  double torsional_stiffness;
  double target;  ///< in Thomas solves
};

const std::vector<Resistance>& resistances() {
  static const std::vector<Resistance> all{
      {"chain", AttachmentType::hinge, 0, 0, 6},
      {"bent", AttachmentType::clamp, 0.01, 0, 10},
      {"bent, twisted", AttachmentType::clamp, 0.01, 0.0075, 25},
      {"whole rod", AttachmentType::clamp, {0.01, 0.005}, 0.0075, 25},
  };
  return all;
}

/// A cable in its ordinary motion: one end goes to and fro.
class MovingCable {
 public:
  MovingCable(int segments, const Resistance& resistance) : reach_(span * segment_length * segments) {
    SceneDesc scene = scenes::held_by_a_hand(segments, resistance.attachment);
    scene.cables[0].length = segment_length * segments;
    MaterialDesc& material = scene.materials[0].material;
    material.bending_stiffness = resistance.bending_stiffness;
    material.torsional_stiffness = resistance.torsional_stiffness;
    inputs_ = scenes::hand_at({reach_, 0, 0});
    world_ = std::make_unique<World>(scene, inputs_);
    world_->settle();
  }
  void run() {
    const double t = world_->time() + world_->time_step();
    inputs_[1].pose.position.x() = reach_ + 0.1 * (1 - std::cos(2 * pi * t));
    inputs_[1].pose.orientation = Eigen::AngleAxisd(std::sin(2 * pi * t), Vector3::UnitX());
    iterations += world_->step(inputs_).iterations;
  }

  long iterations = 0;

 private:
  double reach_;
  BoundaryInputs inputs_;
  std::unique_ptr<World> world_;
};

template <class Work>
double seconds_a_run(Work& work, int runs) {
  const double start = processor_seconds();
  for (int i = 0; i < runs; ++i) work.run();
  return (processor_seconds() - start) / runs;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

struct StepCost {
  double floor = 0, segment = 0;  ///< [s] a row, a segment
  double ratio = 0;               ///< median of those taken side by side
  double iterations = 0;
};

StepCost measure(int segments, const Resistance& resistance, int repetitions) {
  ThomasSolve thomas(segments);
  MovingCable cable(segments, resistance);
  const int runs = std::max(1, 20000 / segments), warm_up = std::max(20, runs);
  for (int i = 0; i < warm_up; ++i) thomas.run(), cable.run();
  cable.iterations = 0;
  std::vector<double> floor, times, ratios;
  for (int i = 0; i < repetitions; ++i) {
    floor.push_back(seconds_a_run(thomas, 10 * runs) / segments);
    times.push_back(seconds_a_run(cable, runs) / segments);
    ratios.push_back(times.back() / floor.back());
  }
  return {median(floor), median(times), median(ratios), static_cast<double>(cable.iterations) / (runs * repetitions)};
}

}  // namespace

void step_cost(Report& report, bool quick) {
  report.table(
      "A step of 1 ms with all its iterations, in Thomas solves of the same length (1 cm segments, one end driven 0.1 m at 1 Hz)",
      {"        cable", "     n", "Thomas [ns/row]", "step [ns/seg]", "iterations", "in solves", "target", "verdict"});
  for (const Resistance& resistance : resistances()) {
    double cheapest = 1e300, dearest = 0;
    for (const int n : quick ? std::vector<int>{100, 1000, 10000} : std::vector<int>{100, 1000, 10000, 100000}) {
      const StepCost cost = measure(n, resistance, quick ? 5 : 9);
      cheapest = std::min(cheapest, cost.segment);
      dearest = std::max(dearest, cost.segment);
      report.row({resistance.name, std::to_string(n), figure(1e9 * cost.floor), figure(1e9 * cost.segment),
                  figure(cost.iterations), figure(cost.ratio), figure(resistance.target),
                  report.at_most(cost.ratio, resistance.target)});
    }
    report.note(std::string(resistance.name) + ": dearest segment over cheapest " + figure(dearest / cheapest) +
                " (target 1.25, " + report.at_most(dearest / cheapest, 1.25) + ")");
  }
}

}  // namespace verlet_cable::bench

#include "acceptance.h"

#include <algorithm>
#include <cmath>

#include "stopwatch.h"

namespace verlet_cable::bench {

namespace {

constexpr double tip_time = 0.4, expected_tip_height = -0.785, tip_tolerance = 0.015;
constexpr double gravity = 9.81;

double largest_strain(const RopeTask& task, const std::vector<Vector3>& positions) {
  double strain = 0;
  const double rest = task.length / task.segments;
  for (int i = 0; i < task.segments; ++i)
    strain = std::max(strain, std::abs((positions[i + 1] - positions[i]).norm() / rest - 1));
  return strain;
}

double energy(const RopeTask& task, const std::vector<Vector3>& positions, const std::vector<Vector3>& velocities) {
  double sum = 0;
  for (int i = 0; i <= task.segments; ++i)
    sum += task.node_mass(i) * (0.5 * velocities[i].squaredNorm() + gravity * positions[i].z());
  return sum;
}

}  // namespace

Verdict check(Rope& rope, const RopeTask& task, const Criteria& criteria, double processor_limit) {
  Verdict verdict;
  std::vector<Vector3> positions, velocities;
  const auto breach = [&](const std::string& reason) {
    verdict.reason = reason;
    verdict.progress = rope.time();
    return verdict;
  };
  rope.observe(positions, velocities);
  const double initial = energy(task, positions, velocities), start = processor_seconds();
  bool tip_seen = false;
  while (rope.time() < criteria.duration - 1e-9) {
    rope.advance();
    rope.observe(positions, velocities);
    if (!positions[task.segments].allFinite()) return breach("not finite");
    verdict.strain = std::max(verdict.strain, largest_strain(task, positions));
    const double gain = (energy(task, positions, velocities) - initial) / task.energy_scale();
    verdict.energy_gain = std::max(verdict.energy_gain, gain);
    verdict.energy_error = std::max(verdict.energy_error, std::abs(gain));
    if (!(verdict.strain < criteria.strain)) return breach("strain");
    if (verdict.energy_gain > criteria.energy_gain) return breach("energy gain");
    if (verdict.energy_error > criteria.energy_error) return breach("energy error");
    if (!tip_seen && rope.time() > tip_time - 1e-9) {
      tip_seen = true;
      verdict.tip_height = positions.back().z();
      if (criteria.tip_height && std::abs(verdict.tip_height - expected_tip_height) > tip_tolerance) return breach("tip height");
    }
    if (processor_seconds() - start > processor_limit) return breach("too slow");
  }
  verdict.accepted = true;
  verdict.progress = criteria.duration;
  return verdict;
}

double processor_time_per_second(Rope& rope, double duration, double processor_limit) {
  const double start = processor_seconds(), begin = rope.time();
  do {
    for (int i = 0; i < 16 && rope.time() < duration - 1e-9; ++i) rope.advance();
  } while (rope.time() < duration - 1e-9 && processor_seconds() - start < processor_limit);
  return (processor_seconds() - start) / (rope.time() - begin);
}

}  // namespace verlet_cable::bench

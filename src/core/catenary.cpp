#include "catenary.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <numeric>

namespace verlet_cable {

namespace {

constexpr int maximum_iterations = 200;
constexpr double straight = 1 - 1e-6;         // of the length: from there on a line
constexpr double narrowest = 1e-3;            // of the length: two ends above each other are spread so far
constexpr double position_tolerance = 1e-13;  // of the length

/// The chain's end and the complementary energy whose gradient it is, as functions of the force in its first link.
struct ChainEnd {
  Vector3 position = Vector3::Zero();
  Eigen::Matrix3d slope = Eigen::Matrix3d::Zero();
  double energy = 0;
};

ChainEnd chain_end(const Vector3& first_force, const std::vector<double>& lengths, const std::vector<double>& weights,
                   const Vector3& down, double axial_stiffness) {
  ChainEnd end;
  Vector3 force = first_force;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    const double tension = std::max(force.norm(), 1e-12);
    const Vector3 direction = force / tension;
    end.position += lengths[i] * (1 + tension / axial_stiffness) * direction;
    end.slope += lengths[i] / tension * (Eigen::Matrix3d::Identity() - direction * direction.transpose()) +
                 lengths[i] / axial_stiffness * Eigen::Matrix3d::Identity();
    end.energy += lengths[i] * tension * (1 + 0.5 * tension / axial_stiffness);
    if (i < weights.size()) force -= weights[i] * down;
  }
  return end;
}

}  // namespace

std::vector<Vector3> hanging_chain(const Vector3& from, const Vector3& to, const std::vector<double>& lengths,
                                   const std::vector<double>& weights, const Vector3& down, double axial_stiffness) {
  const double length = std::accumulate(lengths.begin(), lengths.end(), 0.0);
  const double weight = std::accumulate(weights.begin(), weights.end(), 0.0);
  if (lengths.size() == 1) return {from, to};
  // Added up from zero: far from the origin each sum would round.
  std::vector<Vector3> nodes{Vector3::Zero()};
  Vector3 span = to - from;
  if (span.norm() >= straight * length && !(axial_stiffness < std::numeric_limits<double>::infinity())) {
    double along = 0;
    for (const double l : lengths) nodes.push_back((along += l) / length * span);
    for (Vector3& node : nodes) node += from;
    return nodes;
  }
  const Vector3 level = span - span.dot(down) * down;
  if (level.norm() < narrowest * length) {
    const Vector3 side = level.norm() > 0 ? Vector3(level.normalized()) : Vector3(down.unitOrthogonal());
    span += narrowest * length * side - level;
  }

  // The force in the first link maximises the complementary energy, which is concave: Newton's method with halved steps.
  Vector3 force = -0.5 * weight * down + (0.1 * weight + 1e-9) * (span - span.dot(down) * down).normalized();
  for (int iteration = 0; iteration < maximum_iterations; ++iteration) {
    const ChainEnd end = chain_end(force, lengths, weights, down, axial_stiffness);
    const Vector3 miss = span - end.position;
    if (miss.norm() < position_tolerance * length) break;
    const Vector3 change = end.slope.ldlt().solve(miss);
    const double objective = end.energy - force.dot(span);
    double part = 1;
    for (int halvings = 0; halvings < 60; ++halvings, part *= 0.5) {
      const Vector3 trial = force + part * change;
      if (chain_end(trial, lengths, weights, down, axial_stiffness).energy - trial.dot(span) <= objective) break;
    }
    force += part * change;
  }

  for (std::size_t i = 0; i < lengths.size(); ++i) {
    const double tension = std::max(force.norm(), 1e-12);
    nodes.push_back(nodes.back() + lengths[i] * (1 / tension + 1 / axial_stiffness) * force);
    if (i < weights.size()) force -= weights[i] * down;
  }
  for (Vector3& node : nodes) node += from;
  return nodes;
}

}  // namespace verlet_cable

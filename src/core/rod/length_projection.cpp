#include "rod/length_projection.h"

#include <algorithm>
#include <cmath>

#include "rod/tridiagonal.h"

namespace verlet_cable {

namespace {

constexpr int maximum_iterations = 100;
constexpr double length_tolerance = 1e-12;  // relative
constexpr double straight = 1 - 1e-7;       // of a span's length
constexpr double regularisation = 1e-12;    // relative, for spans pulled straight

/// J M^-1 J^T for the segments' lengths, and its solution for given changes of ½ s².
class LengthSystem {
 public:
  LengthSystem(const CableModel& model, const std::vector<HeldNode>& held) : mobility_(model.nodes()) {
    for (int i = 0; i < model.nodes(); ++i) mobility_[i] = 1 / model.masses[i];
    for (const HeldNode& h : held) mobility_[h.node] = 0;
    diagonal_.resize(model.segments());
    off_.resize(model.segments());
    impulse_.resize(model.segments());
  }

  /// Adds M^-1 J^T y to `vectors` for J M^-1 J^T y = changes, J from `positions`.
  void apply(const std::vector<Vector3>& positions, const std::vector<double>& changes, std::vector<Vector3>& vectors) {
    const std::size_t n = changes.size();
    for (std::size_t i = 0; i < n; ++i) {
      const Vector3 d = positions[i + 1] - positions[i];
      const double mobility = mobility_[i] + mobility_[i + 1];
      diagonal_[i] = mobility > 0 ? d.squaredNorm() * mobility * (1 + regularisation) : 1;
      impulse_[i] = mobility > 0 ? changes[i] : 0;
      if (i + 1 < n) off_[i] = -mobility_[i + 1] * d.dot(positions[i + 2] - positions[i + 1]);
    }
    solve_tridiagonal(diagonal_, off_, impulse_, static_cast<int>(n));
    Vector3 direction = positions[1] - positions[0];
    for (std::size_t i = 0; i < n; ++i) {
      const Vector3 impulse = impulse_[i] * direction;
      if (i + 1 < n) direction = positions[i + 2] - positions[i + 1];
      vectors[i] -= mobility_[i] * impulse;
      vectors[i + 1] += mobility_[i + 1] * impulse;
    }
  }

  bool movable_node(int node) const { return mobility_[node] > 0; }
  bool movable(int segment) const { return mobility_[segment] + mobility_[segment + 1] > 0; }

 private:
  std::vector<double> mobility_, diagonal_, off_, impulse_;
};

/// Spans that their holders pull straight have only one shape.
void straighten_taut_spans(const CableModel& model, const std::vector<HeldNode>& held, std::vector<Vector3>& positions) {
  for (std::size_t k = 0; k + 1 < held.size(); ++k) {
    const int first = held[k].node, last = held[k + 1].node;
    const Vector3 span = held[k + 1].position - held[k].position;
    const double rest_length = model.length(first, last);
    if (span.norm() < straight * rest_length) continue;
    double along = 0;
    for (int i = first; i + 1 < last; ++i) {
      along += model.rest_lengths[i];
      positions[i + 1] = held[k].position + along / rest_length * span;
    }
  }
}

}  // namespace

bool project_positions(const CableModel& model, const std::vector<HeldNode>& held, std::vector<Vector3>& positions) {
  for (const HeldNode& h : held) positions[h.node] = h.position;
  if (model.material.axial_stiffness < infinity) return true;
  straighten_taut_spans(model, held, positions);
  std::vector<double> lengths(model.segments());
  reachable_lengths(model, held, lengths);
  return project_lengths(model, held, lengths, positions);
}

bool project_lengths(const CableModel& model, const std::vector<HeldNode>& held, const std::vector<double>& lengths,
                     std::vector<Vector3>& positions) {
  const int n = model.segments();
  std::vector<double> changes(n);
  LengthSystem system(model, held);
  // Seen from the cable's first node: far from the origin, rounding of the places outweighs what is left of the lengths.
  const Vector3 origin = positions.front();
  std::vector<Vector3> local;
  for (const Vector3& position : positions) local.push_back(position - origin);
  for (int iteration = 0; iteration < maximum_iterations; ++iteration) {
    double error = 0;
    for (int i = 0; i < n; ++i) {
      const double square = (local[i + 1] - local[i]).squaredNorm(), target = lengths[i] * lengths[i];
      // A segment is not asked to grow or shrink by more than a part of itself at a time: Newton's model holds no further.
      changes[i] = 0.5 * std::clamp(target - square, -0.75 * square, 0.75 * std::max(square, 0.01 * target));
      if (system.movable(i)) error = std::max(error, std::abs(target - square) / target);
    }
    if (!std::isfinite(error)) return false;
    if (error < length_tolerance) {
      for (int i = 0; i <= n; ++i)
        if (system.movable_node(i)) positions[i] = origin + local[i];
      return true;
    }
    const std::vector<Vector3> from = local;
    system.apply(from, changes, local);
  }
  return false;
}

void project_velocities(const CableModel& model, const std::vector<HeldNode>& held, const std::vector<Vector3>& positions,
                        std::vector<Vector3>& velocities) {
  for (const HeldNode& h : held) velocities[h.node] = h.velocity;
  if (model.material.axial_stiffness < infinity) return;
  std::vector<double> changes(model.segments());
  for (int i = 0; i < model.segments(); ++i)
    changes[i] = -(positions[i + 1] - positions[i]).dot(velocities[i + 1] - velocities[i]);
  LengthSystem(model, held).apply(positions, changes, velocities);
}

}  // namespace verlet_cable

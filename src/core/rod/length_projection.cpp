#include "rod/length_projection.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "law/flow_rate.h"
#include "rod/tridiagonal.h"
#include "verlet_cable/core/cable_materials.h"

namespace verlet_cable {

namespace {

constexpr int projection_iterations = 100;
constexpr double length_tolerance = 1e-12;  // relative, of squares
constexpr double rounding_of_position =
    8 * std::numeric_limits<double>::epsilon();  // of places, likewise: a long cable's is more
constexpr double straight_span = 1 - 1e-7;       // of a span's length
constexpr double regularisation = 1e-12;         // as length_rate_regularisation, of what is solved again and again

/// J M^-1 J^T for the segments' lengths, and its solution for given changes of ½ s². Segments of length 0 in `lengths`, one a
/// segment or none, are free to have any.
class LengthSystem {
 public:
  LengthSystem(const std::vector<double>& masses, const std::vector<HeldNode>& held, const std::vector<double>& lengths)
      : mobility_(masses.size()), lengths_(lengths) {
    for (std::size_t i = 0; i < masses.size(); ++i) mobility_[i] = 1 / masses[i];
    for (const HeldNode& h : held) mobility_[h.node] = 0;
    diagonal_.resize(masses.size() - 1);
    off_.resize(masses.size() - 1);
    impulse_.resize(masses.size() - 1);
  }

  /// What flows through guides has these velocities; friction that is not infinite does nothing at once.
  void set_flows(const CableModel& model, const CableState& state, std::vector<GuidedFlow>& flows) {
    flows_ = &flows;
    rates_.clear();
    for (const GuidedFlow& flow : flows) {
      const double density = CableMaterials(model, state)[flow.first].linear_density;
      const bool stands = flow.friction == infinity || flow.is_blocked[0] || flow.is_blocked[1];
      const double mass = density * flowing_length(state.rest_lengths, flow.first, flow.last) + flow.inertia;
      rates_.push_back({flow.first, flow.last, state.rest_lengths[flow.first - 1], state.rest_lengths[flow.last],
                        stands ? infinity : mass, flow.rate});
    }
  }

  /// Adds M^-1 J^T y to `vectors` for J M^-1 J^T y = changes, J from `positions`.
  void apply(const std::vector<Vector3>& positions, const std::vector<double>& changes, std::vector<Vector3>& vectors) {
    const std::size_t n = changes.size();
    for (std::size_t i = 0; i < n; ++i) {
      const Vector3 d = positions[i + 1] - positions[i];
      diagonal_[i] = is_free(i) ? 1 : length_rate_diagonal(d.squaredNorm(), mobility_[i] + mobility_[i + 1], regularisation);
      impulse_[i] = is_free(i) ? 0 : changes[i];
      if (i + 1 < n) off_[i] = length_rate_coupling(d.dot(positions[i + 2] - positions[i + 1]), mobility_[i + 1]);
      if (i + 1 < n && (is_free(i) || is_free(i + 1))) off_[i] = 0;
    }
    for (const FlowRate& flow : rates_)
      if (!is_free(flow.before())) add_flow_rate(flow, diagonal_, off_, impulse_);
    keep_unmoved(static_cast<int>(n), diagonal_, impulse_);
    solve_tridiagonal(diagonal_, off_, impulse_, static_cast<int>(n));
    for (std::size_t k = 0; k < rates_.size(); ++k)
      if (!is_free(rates_[k].before())) (*flows_)[k].rate += change_of_rate(rates_[k], impulse_);
    Vector3 direction = positions[1] - positions[0];
    for (std::size_t i = 0; i < n; ++i) {
      const Vector3 impulse = impulse_[i] * direction;
      if (i + 1 < n) direction = positions[i + 2] - positions[i + 1];
      vectors[i] -= mobility_[i] * impulse;
      vectors[i + 1] += mobility_[i + 1] * impulse;
    }
  }

  bool movable_node(int node) const { return mobility_[node] > 0; }
  bool movable(std::size_t segment) const { return mobility_[segment] + mobility_[segment + 1] > 0 && !is_free(segment); }

 private:
  bool is_free(std::size_t segment) const { return lengths_[segment] == 0; }

  std::vector<GuidedFlow>* flows_ = nullptr;
  std::vector<FlowRate> rates_;
  std::vector<double> mobility_, diagonal_, off_, impulse_;
  const std::vector<double>& lengths_;
};

/// Spans that their holders pull straight have only one shape.
void straighten_taut_spans(const CableMaterials& materials, const std::vector<HeldNode>& held, CableState& state) {
  for (std::size_t k = 0; k + 1 < held.size(); ++k) {
    const int first = held[k].node, last = held[k + 1].node;
    if (materials.any_elastic_between(first, last)) continue;
    const Vector3 span = held[k + 1].position - held[k].position;
    const double rest_length = state.length(first, last);
    if (span.norm() < straight_span * rest_length) continue;
    double along = 0;
    for (int i = first; i + 1 < last; ++i) {
      along += state.rest_lengths[i];
      state.positions[i + 1] = held[k].position + along / rest_length * span;
    }
  }
}

void free_elastic(const CableMaterials& materials, std::vector<double>& lengths) {
  for (std::size_t i = 0; i < lengths.size(); ++i)
    if (is_elastic(materials[static_cast<int>(i)])) lengths[i] = 0;
}

}  // namespace

bool project_positions(const CableModel& model, const std::vector<HeldNode>& held, CableState& state) {
  for (const HeldNode& h : held) state.positions[h.node] = h.position;
  const CableMaterials materials(model, state);
  if (!materials.any_rigid()) return true;
  straighten_taut_spans(materials, held, state);
  std::vector<double> lengths(state.segments());
  reachable_lengths(model, state, held, lengths);
  free_elastic(materials, lengths);
  return project_lengths(held, lengths, state);
}

bool project_lengths(const std::vector<HeldNode>& held, const std::vector<double>& lengths, CableState& state) {
  const int n = state.segments();
  std::vector<double> changes(n);
  LengthSystem system(state.masses, held, lengths);
  // Seen from the cable's first node: far from the origin, rounding of the places outweighs what is left of the lengths.
  const Vector3 origin = state.positions.front();
  std::vector<Vector3> local;
  for (const Vector3& position : state.positions) local.push_back(position - origin);
  for (int iteration = 0; iteration < projection_iterations; ++iteration) {
    double error = 0, extent = 0;
    for (const Vector3& place : local) extent = std::max(extent, place.cwiseAbs().maxCoeff());
    for (int i = 0; i < n; ++i) {
      const double square = (local[i + 1] - local[i]).squaredNorm(), target = lengths[i] * lengths[i];
      // A segment is not asked to grow or shrink by more than a part of itself at a time: Newton's model holds no further.
      changes[i] = 0.5 * std::clamp(target - square, -0.75 * square, 0.75 * std::max(square, 0.01 * target));
      if (!std::isfinite(square) || !std::isfinite(target)) return false;  // std::max would lose what is not a number
      const double tolerated = std::max(length_tolerance, rounding_of_position * extent / lengths[i]);
      if (system.movable(i)) error = std::max(error, std::abs(target - square) / (tolerated * target));
    }
    if (error < 1) {
      for (int i = 0; i <= n; ++i)
        if (system.movable_node(i)) state.positions[i] = origin + local[i];
      return true;
    }
    const std::vector<Vector3> from = local;
    system.apply(from, changes, local);
  }
  return false;
}

namespace {

void project_velocities(const CableModel& model, const std::vector<HeldNode>& held, const std::vector<GrowingSegment>& growing,
                        std::vector<GuidedFlow>* flows, CableState& state) {
  const std::vector<Vector3>& positions = state.positions;
  std::vector<Vector3>& velocities = state.velocities;
  for (const HeldNode& h : held) velocities[h.node] = h.velocity;
  const CableMaterials materials(model, state);
  if (!materials.any_rigid()) return;
  std::vector<double> changes(state.segments());
  for (int i = 0; i < state.segments(); ++i)
    changes[i] = -(positions[i + 1] - positions[i]).dot(velocities[i + 1] - velocities[i]);
  for (const GrowingSegment& g : growing)
    changes[g.segment] += (positions[g.segment + 1] - positions[g.segment]).norm() * g.growth;
  std::vector<double> lengths = state.rest_lengths;
  free_elastic(materials, lengths);
  // Where the tension says how fast a winch winds, that follows from the nodes' velocities.
  for (const GrowingSegment& g : growing)
    if (g.keeps_tension) lengths[g.segment] = 0;
  LengthSystem system(state.masses, held, lengths);
  if (flows) system.set_flows(model, state, *flows);
  system.apply(positions, changes, velocities);
  // Where both nodes of a segment are held at one place it has no direction, and the system no solution: from rest, then.
  if (std::all_of(velocities.begin(), velocities.end(), [](const Vector3& v) { return v.allFinite(); })) return;
  std::fill(velocities.begin(), velocities.end(), Vector3::Zero());
  for (const HeldNode& h : held) velocities[h.node] = h.velocity;
  if (flows)
    for (GuidedFlow& flow : *flows) flow.rate = 0;
}

}  // namespace

void project_velocities(const CableModel& model, const std::vector<HeldNode>& held, CableState& state) {
  project_velocities(model, held, {}, nullptr, state);
}

void project_velocities(const CableModel& model, Boundary& boundary, CableState& state) {
  project_velocities(model, boundary.nodes, boundary.growing, &boundary.flows, state);
}

}  // namespace verlet_cable

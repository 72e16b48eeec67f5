#include "target/boundary.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "verlet_cable/core/cable_materials.h"

namespace verlet_cable {

namespace {

/// Further apart than this is worth a report [relative]: cables that are taut may be strained by a tenth of it.
constexpr double reported_stretch = 1e-6;
/// Of places far from the origin, which is no stretch [relative].
constexpr double rounding_of_places = 8 * std::numeric_limits<double>::epsilon();

}  // namespace

bool Boundary::is_on_bodies() const {
  return std::any_of(nodes.begin(), nodes.end(), [](const HeldNode& held) { return held.body >= 0; });
}

Vector3 Boundary::load_on(int node) const {
  Vector3 force = Vector3::Zero();
  for (const NodeLoad& load : loads)
    if (load.node == node) force += load.force;
  return force;
}

void HolderMotion::clear() {
  std::fill(displacements.begin(), displacements.end(), Vector3::Zero());
  std::fill(rotations.begin(), rotations.end(), Vector3::Zero());
  for (PointLoad& load : loads) load.force.setZero();
}

namespace {

/// Strain over which a span that is drawn straight comes to yield.
constexpr double yielding_strain = 1e-3;

/// Between holders that the cable does not slide through, by way of those that it does.
struct HeldSpan {
  int first = 0, last = 0;    ///< nodes
  double length = 0;          ///< [m] at rest
  double distance = 0;        ///< [m] of its holders
  double start_distance = 0;  ///< [m] of its nodes, at the start of the substep
  double rounding = 0;        ///< [m] of distances
  bool gives_way = false;     ///< a body holds it
  bool has_branch = false;    ///< at a junction between its holders
};

/// Calls `visit` with every span none of which can stretch.
template <class Visit>
void each_rigid_span(const CableModel& model, const CableState& state, const std::vector<HeldNode>& held, const Visit& visit) {
  const CableMaterials materials(model, state);
  if (!materials.any_rigid()) return;
  std::size_t next = 0;
  for (std::size_t k = 0; k + 1 < held.size(); k = next) {
    // On to the next holder that the cable does not slide through; junctions are drawn along.
    HeldSpan span;
    span.gives_way = held[k].body >= 0;
    const HeldNode* last_place = &held[k];
    for (next = k + 1;; ++next) {
      const HeldNode& node = held[next];
      span.has_branch = span.has_branch || node.at_junction;
      if (!node.at_junction) {
        span.distance += (node.position - last_place->position).norm();
        span.start_distance += (state.positions[node.node] - state.positions[last_place->node]).norm();
        last_place = &node;
        span.gives_way = span.gives_way || node.body >= 0;
      }
      if (!(node.slides || node.at_junction) || next + 1 == held.size()) break;
    }
    if (held[k].slides || held[next].slides || held[next].at_junction) continue;
    if (held[k].attachment >= 0 && held[k].attachment == held[next].attachment) continue;
    span.first = held[k].node;
    span.last = held[next].node;
    if (materials.any_elastic_between(span.first, span.last)) continue;
    span.length = state.length(span.first, span.last);
    span.rounding = rounding_of_places * held[k].position.cwiseAbs().maxCoeff();
    visit(span);
  }
}

/// What `length` [m] says of the segments of a span that grow, together.
template <typename Length>
double sum_in(const HeldSpan& span, const std::vector<GrowingSegment>& growing, Length length) {
  double sum = 0;
  for (const GrowingSegment& segment : growing)
    if (segment.segment >= span.first && segment.segment < span.last) sum += length(segment);
  return sum;
}

/// [m] That winches which give way to tension may let out into it in the substep.
double let_out_into(const HeldSpan& span, const std::vector<GrowingSegment>& growing) {
  return sum_in(span, growing, [](const GrowingSegment& segment) { return segment.law.gives() ? segment.law.most : 0; });
}

/// [m] By how much further its holders are apart in a substep of `h` [s], beyond what it grows by.
double drawn_in_substep(const HeldSpan& span, const std::vector<GrowingSegment>& growing, double h) {
  return span.distance - span.start_distance - let_out_into(span, growing) -
         sum_in(span, growing, [h](const GrowingSegment& segment) { return h * segment.growth; });
}

/// [m] By how much it is longer where the state is wound to than at the start of the substep.
double wound_from_start(const HeldSpan& span, const std::vector<GrowingSegment>& growing) {
  return sum_in(span, growing, [](const GrowingSegment& segment) { return segment.way - segment.left; });
}

/// How long it may be at the end of the substep.
HeldSpan let_out(HeldSpan span, const std::vector<GrowingSegment>& growing) {
  span.length += let_out_into(span, growing);
  return span;
}

/// Of the way from a span that is straight, as what is reported has it, to one that yields, 0 to 1, where it is so long [m].
double share_at(double length, const HeldSpan& span) {
  return std::clamp(((length - span.rounding) / span.length - 1 - reported_stretch) / yielding_strain, 0.0, 1.0);
}

/// [m] Of a span as the state has it.
double present_length(const HeldSpan& span, const CableState& state) {
  double length = 0;
  for (int i = span.first; i < span.last; ++i) length += (state.positions[i + 1] - state.positions[i]).norm();
  return length;
}

/// How far a span is on that way. What stays strained, as a bent one does when its holders are already nearer than it is long,
/// goes on to yield nearly as it did, so that it gives back what it has taken: stiffened at once it would give much more. In as
/// long as its holders are looked ahead it comes to its length. A trunk whose holders come nearer does not: limp and unstrained,
/// it might be too straight for the next step.
double yielding_share(const HeldSpan& span, const CableState& state, const std::vector<GrowingSegment>& growing,
                      const YieldingAhead& ahead) {
  const double drawn = drawn_in_substep(span, growing, ahead.substep), soon = ahead.time / ahead.substep * std::max(0.0, drawn);
  double left = 0;
  const bool may_stay = ahead.time > 0 && (!span.has_branch || drawn >= -span.rounding);
  if (state.yielding > 0 && may_stay && share_at(present_length(span, state) + std::min(0.0, drawn), span) > 0)
    left = state.yielding * std::exp(-ahead.substep / ahead.time);
  return std::max(left, share_at(span.distance + soon, span));
}

void lengthen(const HeldSpan& span, double distance, std::vector<double>& lengths) {
  const double stretch = distance / span.length;
  if (stretch <= 1) return;
  for (int i = span.first; i < span.last; ++i) lengths[i] *= stretch;
}

}  // namespace

void reachable_lengths(const CableModel& model, const CableState& state, const std::vector<HeldNode>& held,
                       std::vector<double>& lengths) {
  std::copy_n(state.rest_lengths.begin(), state.segments(), lengths.begin());
  each_rigid_span(model, state, held, [&](const HeldSpan& span) {
    if (!span.gives_way) lengthen(span, span.distance, lengths);
  });
}

int lengths_in_substep(const CableModel& model, const CableState& state, const Boundary& boundary, DrawnOut drawn_out,
                       const YieldingAhead& ahead, std::vector<double>& lengths, std::vector<OverstretchedSpan>& spans) {
  std::copy_n(state.rest_lengths.begin(), state.segments(), lengths.begin());
  spans.clear();
  int first = -1;
  each_rigid_span(model, state, boundary.nodes, [&](const HeldSpan& found) {
    const HeldSpan span = let_out(found, boundary.growing);
    // What bodies have drawn out is what the span lacked at the start.
    const double distance = span.gives_way ? span.start_distance + wound_from_start(found, boundary.growing) : span.distance;
    const bool is_too_short = distance > span.length * (1 + reported_stretch) + span.rounding;
    if (is_too_short && first < 0 && (!span.gives_way || drawn_out.is_reported)) first = span.first;
    if (span.gives_way) {
      lengthen(span, distance - drawn_out.drawn_in, lengths);
      return;
    }
    const double share = yielding_share(span, state, boundary.growing, ahead);
    if (share > 0) spans.push_back({span.first, span.last, std::max(0.0, distance / span.length - 1), share});
  });
  return first;
}

bool any_overstretched(const CableModel& model, const CableState& state, const Boundary& boundary, const YieldingAhead& ahead) {
  bool found = false;
  each_rigid_span(model, state, boundary.nodes, [&](const HeldSpan& span) {
    found |= !span.gives_way && yielding_share(let_out(span, boundary.growing), state, boundary.growing, ahead) > 0;
  });
  return found;
}

}  // namespace verlet_cable

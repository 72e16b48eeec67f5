// What flows through guides leave in the state at the end of a substep of CableStepper.
#include <algorithm>
#include <cmath>

#include "guide/flow.h"
#include "rod/bending_memory.h"
#include "rod/cable_stepper.h"
#include "rod/rod_frames.h"

namespace verlet_cable {

namespace {

/// What the material at the guide's nodes has: where it comes from, there it was.
template <class T>
void flow_on(const Flow& flow, const std::vector<double>& rest_lengths, std::vector<T>& values) {
  for (const int node : {flow.first, flow.last}) {
    const int from = flow.way > 0 ? node - 1 : node + 1;
    const double length = rest_lengths[std::min(from, node)];
    values[node] = mean(values[node], values[from], std::min(std::abs(flow.way) / length, 1.0));
    if (flow.first == flow.last) break;
  }
}

/// What is remembered goes with the material, by the lengths that it had.
void carry_memory(const Flow& flow, CableState& state) {
  const int border = 2 * flow.before + 1;
  if (flow.first == flow.last)
    carry_bends(border, {0.5 * flow.way, flow.way, 0.5 * flow.way}, state);
  else
    carry_bends(border, {0.5 * flow.way, flow.way, flow.way, flow.way, 0.5 * flow.way}, state);
}

}  // namespace

void CableStepper::finish_flows(const Substep& s, CableState& state) {
  if (!state.bending_memory.empty())
    for (const Flow& flow : flows_) carry_memory(flow, state);
  for (std::size_t k = 0; k < flows_.size(); ++k) {
    const Flow& flow = flows_[k];
    const double half_density = 0.5 * flow.density;
    GuidedFlow& guided = s.boundary.flows[k];
    double rate = s.statics || comes_to_rest(s, flow) ? 0 : end_rate(s, flow);
    if ((flow.mode == Flow::Mode::forward && rate < 0) || (flow.mode == Flow::Mode::backward && rate > 0)) rate = 0;
    guided.rate = rate;
    guided.acceleration = s.statics ? 0 : (rate - flow.rate) / s.h;
    if (s.scheme == Scheme::damped) guided.acceleration = (flow.way / s.h - flow.rate) / s.h + 0.5 * flow.acceleration;
    if (!s.statics) guided.held_way += flow.way;
    state.rest_lengths[flow.before] -= flow.way;
    state.rest_lengths[flow.after] += flow.way;
    state.masses[flow.before] -= half_density * flow.way;
    state.masses[flow.first] -= half_density * flow.way;
    state.masses[flow.last] += half_density * flow.way;
    state.masses[flow.after + 1] += half_density * flow.way;
  }
}

/// The frame of a segment that flows on is that of other material then, in its middle.
void CableStepper::carry_frames_with_flows(const CableModel& model, CableState& state) const {
  const auto twist_rate = [&](int node) {
    if (node < 0 || node > segments_) return 0.0;
    return material_twist(model, state, node) / joint_length(state, node);
  };
  for (const Flow& flow : flows_) {
    // Where what comes to the middle is now
    const std::array<double, 2> rates = flow.way > 0 ? std::array{twist_rate(flow.before), twist_rate(flow.last)}
                                                     : std::array{twist_rate(flow.first), twist_rate(flow.after + 1)};
    for (const int side : {0, 1}) {
      const int segment = side == 0 ? flow.before : flow.after;
      const double turn = -0.5 * flow.way * rates[side];
      turn_segment(segment, turn, state);
      state.joint_twist[segment] += turn;
      state.joint_twist[segment + 1] -= turn;
    }
    if (!state.rest_curvature.empty()) flow_on(flow, state.rest_lengths, state.rest_curvature);
    if (!state.rest_twist.empty()) flow_on(flow, state.rest_lengths, state.rest_twist);
  }
}

}  // namespace verlet_cable

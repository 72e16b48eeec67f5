// What impulses along the cable change of the flows through guides, where CableStepper projects velocities.
#include <cmath>

#include "rod/cable_stepper.h"

namespace verlet_cable {

/// The linear system is that of impulses, whose unknowns for flows are the changes of their rates.
void CableStepper::begin_flow_projection(const Substep& s, const CableState& state) {
  system_.flow_load.assign(flows_.size(), 0.0);
  for (std::size_t k = 0; k < flows_.size(); ++k) {
    Flow& flow = flows_[k];
    const bool moves = !comes_to_rest(s, flow);
    const double rate = s.boundary.flows[k].rate;
    flow.row = flow.gap = {0, 0};
    flow.column.fill(Vector3::Zero());
    flow.rubbing.fill(Vector3::Zero());
    flow.diagonal = moves ? -flow.mass : -1;
    for (const int side : {0, 1}) {
      const int i = side == 0 ? flow.before : flow.after;
      if (is_elastic_at(i)) continue;
      const double length = side == 0 ? -state.rest_lengths[i] : state.rest_lengths[i];
      system_.gap[i] += length * rate;
      flow.gap[side] = length;
      if (moves) flow.row[side] = length;
    }
  }
}

/// In the system of impulses.
FlowRate CableStepper::rate_of(const Substep& s, const Flow& flow) const {
  return {flow.first,
          flow.last,
          target_length_[flow.before],
          target_length_[flow.after],
          comes_to_rest(s, flow) ? infinity : flow.mass,
          s.boundary.flows[&flow - flows_.data()].rate};
}

/// Impulses along the segments beside a guide move what flows, too.
void CableStepper::project_flows(const Substep& s) {
  for (const Flow& flow : flows_)
    if (!is_elastic_at(flow.before)) add_flow_rate(rate_of(s, flow), pivot_, off_, impulse_);
  keep_unmoved(segments_, pivot_, impulse_);
}

void CableStepper::push_flows(const Substep& s, SubstepResult& result) {
  for (std::size_t k = 0; k < flows_.size(); ++k) {
    const Flow& flow = flows_[k];
    if (!is_elastic_at(flow.before)) mend_flow(flow, change_of_rate(rate_of(s, flow), impulse_), s.boundary.flows[k], result);
  }
}

/// As velocities are mended. `change`: of the rate [m/s].
void CableStepper::mend_flow(const Flow& flow, double change, GuidedFlow& guided, SubstepResult& result) {
  result.balance.dissipated.unresolved -= flow.mass * change * (guided.rate + 0.5 * change);
  guided.rate += change;
}

}  // namespace verlet_cable

#pragma once

#include <vector>

#include "law/length_rate.h"
#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// What flows through a guide in the system of impulses of length_rate.h. Its rate is one more unknown: impulses along the
/// segments beside the guide, times their lengths, change it as if it was a mass between them.
struct FlowRate {
  int first = 0, last = 0;                     ///< the guide's nodes; one segment is between them, or none
  double length_before = 0, length_after = 0;  ///< [m] of the segments beside them
  double mass = 0;                             ///< [kg] that moves; infinite: it stands
  double rate = 0;                             ///< [m/s] before the impulses

  int before() const { return first - 1; }
  int after() const { return last; }
};

/// Adds it to the rows of the segments beside the guide. Rows that are all 0 are those of segments between two holders, whose
/// lengths nothing but flows changes.
inline void add_flow_rate(const FlowRate& flow, std::vector<double>& diagonal, std::vector<double>& coupling,
                          std::vector<double>& rates) {
  const int i = flow.before(), j = flow.after();
  rates[i] -= flow.length_before * flow.rate;
  rates[j] += flow.length_after * flow.rate;
  if (flow.mass == infinity) return;
  if (flow.first == flow.last) {
    diagonal[i] += flow.length_before * flow.length_before / flow.mass;
    diagonal[j] += flow.length_after * flow.length_after / flow.mass;
    coupling[i] = -flow.length_before * flow.length_after / flow.mass;
    return;
  }
  // The segment on a wheel has no impulse: its place is that of the change of the rate.
  diagonal[flow.first] = -flow.mass;
  coupling[i] = flow.length_before;
  coupling[flow.first] = -flow.length_after;
  if (diagonal[i] == 0) diagonal[i] = length_rate_regularisation * flow.length_before * flow.length_before / flow.mass;
  if (diagonal[j] == 0) diagonal[j] = length_rate_regularisation * flow.length_after * flow.length_after / flow.mass;
}

/// What no flow moves either has no impulse. `rows`: of the system.
inline void keep_unmoved(int rows, std::vector<double>& diagonal, std::vector<double>& rates) {
  for (int i = 0; i < rows; ++i) {
    if (diagonal[i] != 0) continue;
    diagonal[i] = 1;
    rates[i] = 0;
  }
}

/// [m/s] That the impulses change its rate by; takes it out of them.
inline double change_of_rate(const FlowRate& flow, std::vector<double>& impulses) {
  if (flow.first != flow.last) impulses[flow.first] = 0;
  return (flow.length_before * impulses[flow.before()] - flow.length_after * impulses[flow.after()]) / flow.mass;
}

}  // namespace verlet_cable

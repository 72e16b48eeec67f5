#include "rod/stiff_ends.h"

#include <algorithm>

namespace verlet_cable {

namespace {

/// So little of what is stiff bends all the same: nothing beside the rest, but a number that the solver can take.
constexpr double least_share = 1e-3;

}  // namespace

void set_stiff_ends(const std::array<double, 2>& lengths, CableState& state) {
  if (lengths[0] == 0 && lengths[1] == 0) return;
  const std::vector<double> arc_length = state.arc_length();
  const double first = lengths[0], last = arc_length.back() - lengths[1];
  const int n = state.segments();
  state.flexible_fraction.resize(n + 1);
  for (int i = 0; i <= n; ++i) {
    const double low = arc_length[i] - (i > 0 ? 0.5 * state.rest_lengths[i - 1] : 0),
                 high = arc_length[i] + (i < n ? 0.5 * state.rest_lengths[i] : 0);
    const double bends = std::min(high, last) - std::max(low, first);
    state.flexible_fraction[i] = std::max(bends / (high - low), least_share);
  }
}

}  // namespace verlet_cable

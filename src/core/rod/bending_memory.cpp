#include "rod/bending_memory.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "verlet_cable/core/cable_materials.h"

namespace verlet_cable {

HalfBend sum_of(std::initializer_list<std::pair<double, HalfBend>> shares) {
  HalfBend sum;
  for (const auto& [share, half] : shares)
    for (const int axis : {0, 1}) {
      sum.yielded[axis] += share * half.yielded[axis];
      sum.slipped[axis] += share * half.slipped[axis];
    }
  return sum;
}

void fit_bending_memory(const CableModel& model, CableState& state) {
  const auto remembers = [](const MaterialDesc& material) { return material.remembers_bending(); };
  if (state.bending_memory.empty() && CableMaterials(model, state).any(remembers))
    state.bending_memory.assign(state.segments(), {});
}

HalfBend bends_at_border(int border, double way, const CableState& state) {
  const int half = way > 0 ? border - 1 : border;
  if (half < 0 || half >= 2 * state.segments()) return {};
  const int segment = half / 2;
  return sum_of({{2 / state.rest_lengths[segment], state.bending_memory[segment][half % 2]}});
}

void carry_bends(int first_border, std::initializer_list<double> ways, CableState& state) {
  constexpr int most_borders = 5;
  assert(ways.size() <= most_borders);
  const int halves = 2 * state.segments();
  const auto is_there = [halves](int half) { return half >= 0 && half < halves; };
  const auto at = [&](int half) -> HalfBend& { return state.bending_memory[half / 2][half % 2]; };
  std::array<HalfBend, most_borders + 1> before;
  for (int k = 0; k <= static_cast<int>(ways.size()); ++k)
    if (is_there(first_border - 1 + k)) before[k] = at(first_border - 1 + k);
  int k = 0;
  for (const double way : ways) {
    const int from = way > 0 ? k : k + 1, to = way > 0 ? k + 1 : k, half = first_border - 1 + from;
    ++k;
    if (!is_there(half)) continue;
    const double part = std::min(2 * std::abs(way) / state.rest_lengths[half / 2], 1.0);
    at(half) = sum_of({{1, at(half)}, {-part, before[from]}});
    if (is_there(first_border - 1 + to))
      at(first_border - 1 + to) = sum_of({{1, at(first_border - 1 + to)}, {part, before[from]}});
  }
}

}  // namespace verlet_cable

#include "contact/nearest_touches.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>

#include "contact/keep_nearest.h"

namespace verlet_cable {
namespace {

/// Obstacles that a node or segment touches: all of them, unless those of a cable touch twice as many on average.
constexpr std::size_t nearest_obstacles = 8;

}  // namespace

std::size_t room_around(double radius, double length, double thinnest, double shortest) {
  const double around = std::ceil(M_PI * (radius + thinnest) / thinnest);
  const double along = 2 + std::ceil((length + 2 * (radius + thinnest)) / shortest);
  return static_cast<std::size_t>(std::min(around * along, 1e6));
}

void keep_nearest_pairs(std::size_t most, std::vector<NearPair>& pairs) {
  const auto before = [](const NearPair& a, const NearPair& b) {
    return std::tie(a.second.cable, a.second.segment) < std::tie(b.second.cable, b.second.segment);
  };
  const auto nearer = [&](const NearPair& a, const NearPair& b) { return a.gap != b.gap ? a.gap < b.gap : before(a, b); };
  keep_nearest(0, most, pairs, nearer, before);
}

void keep_nearest_obstacles(std::size_t first, std::size_t elements, std::vector<Touch>& touches) {
  if (touches.size() - first <= 2 * nearest_obstacles * elements) return;
  std::vector<std::tuple<std::uint64_t, double, std::size_t>> order;
  for (std::size_t k = first; k < touches.size(); ++k) order.emplace_back(touches[k].other_key, touches[k].gap, k);
  std::sort(order.begin(), order.end());
  std::vector<std::size_t> kept;
  std::size_t of_element = 0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    of_element = k > 0 && std::get<0>(order[k]) == std::get<0>(order[k - 1]) ? of_element + 1 : 0;
    if (of_element < nearest_obstacles) kept.push_back(std::get<2>(order[k]));
  }
  std::sort(kept.begin(), kept.end());
  for (std::size_t k = 0; k < kept.size(); ++k) touches[first + k] = touches[kept[k]];
  touches.resize(first + kept.size());
}

}  // namespace verlet_cable

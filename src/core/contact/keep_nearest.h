#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace verlet_cable {

/// Leaves `most` of the items from `first` on: those that come first by `nearer`, in the order of `before`. Both orders are
/// strict and total, so that the same are left wherever they stood.
template <class Item, class Nearer, class Before>
void keep_nearest(std::size_t first, std::size_t most, std::vector<Item>& items, const Nearer& nearer, const Before& before) {
  if (items.size() - first <= most) return;
  const auto begin = items.begin() + static_cast<std::ptrdiff_t>(first), end = begin + static_cast<std::ptrdiff_t>(most);
  std::nth_element(begin, end, items.end(), nearer);
  items.erase(end, items.end());
  std::sort(begin, items.end(), before);
}

}  // namespace verlet_cable

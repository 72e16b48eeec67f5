#include "islands.h"

namespace verlet_cable {

void Islands::build(const State& state) {
  const std::size_t count = state.cables.size();
  const bool together = state.scene->contact && state.scene->contact->between_cables;
  std::size_t grouped = 0;
  for (const Island& island : islands_) grouped += island.cables.size();
  if (grouped == count) return;
  islands_.clear();
  if (count == 0) return;
  islands_.resize(together ? 1 : count);
  for (std::size_t i = 0; i < count; ++i) islands_[together ? 0 : i].cables.push_back(static_cast<int>(i));
}

}  // namespace verlet_cable

#pragma once

#include <vector>

#include "segment_grid.h"
#include "world_state.h"

namespace verlet_cable {

/// Cables that may touch each other: they are advanced in the same substeps.
struct Island {
  std::vector<int> cables;  ///< indices into State::cables, ascending
  SegmentGrid pairs;        ///< of their segments
};

/// What cables are stepped together with; follows from the state.
class Islands {
 public:
  /// Brings them up to date: cables that may touch each other are in one, every cable is in one. Ascending by the first cable.
  void build(const State& state);
  /// Segments have been numbered anew.
  void invalidate() { islands_.clear(); }
  std::vector<Island>& all() { return islands_; }

 private:
  std::vector<Island> islands_;
};

}  // namespace verlet_cable

#pragma once

#include <tbb/cache_aligned_allocator.h>

#include <vector>

#include "rod/lane_sweep.h"

namespace verlet_cable {

class LaneSystem {
 public:
  /// For cables of so many nodes, 2 lanes a cable: 2, 4 or 8.
  void resize(int nodes, int lanes);

  double& at(LaneField field, int cable, int node) { return value(field, place(node), 2 * cable + side(node)); }
  /// Of a segment, in the lane that comes from the start, and likewise from the end: both where they meet.
  template <class Operation>
  void each_lane_of_segment(int segment, const Operation& operation) {
    if (segment <= lane_) operation(segment, 0, 1.0);
    if (segment >= lane_) operation(nodes_ - 2 - segment, 1, -1.0);
  }
  double& value(LaneField field, int place, int lane) {
    return records_[(place * static_cast<int>(LaneField::count) + static_cast<int>(field)) * lanes_ + lane];
  }
  /// Sets what a cable that is not there, or a node that pads it, needs so as to stay as it is.
  void clear(int cable);

  /// One iteration of the cables that are `active` [1 or 0 a lane]. `squares`: the square of the largest correction of a node
  /// [m^2], by lane.
  void sweep(const LaneLaw& law, const double* active, double* squares);

  int lanes() const { return lanes_; }
  int nodes() const { return nodes_; }

 private:
  int place(int node) const { return node <= lane_ ? node : nodes_ - 1 - node; }
  int side(int node) const { return node <= lane_ ? 0 : 1; }

  using Array = std::vector<double, tbb::cache_aligned_allocator<double>>;
  int lanes_ = 0;
  int nodes_ = 0;  ///< even: padded by a held one where necessary
  int lane_ = 0;   ///< nodes that either lane eliminates; two are left in the middle
  Array records_;  ///< lane_ + 2, LaneField::count, lanes
  Array eliminations_;
};

/// The lanes of the widest numbers that this processor computes with: 2, 4 or 8.
int widest_lanes();

}  // namespace verlet_cable
